// Exit statuses (docs/errors.md). Scripts rely on them.
#pragma once

#include "cli/command.h"
#include "crease/result.h"

#include <string>
#include <string_view>

namespace crease::cli {

enum class ExitCode : int {
  Done = 0,
  CommandLine = 1,
  BadInput = 2,      // cannot be read, or is not what it says
  NotSupported = 3,  // by crease, or by this machine's memory
  CannotWrite = 4,
  TargetNotMet = 5,  // with --strict
  Invalid = 6,       // validation failed
  Interrupted = 130,
};

ExitCode exit_code_of(Error error);

// The error's name as docs/errors.md lists it, for --json.
std::string_view name_of(Error error);

// What --json prints of a failure: one object.
std::string failure_json(const Failure& failure);

std::string printed(const Json& json);

}  // namespace crease::cli
