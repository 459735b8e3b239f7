#include "cli/exit_code.h"

namespace crease::cli {

namespace {

struct Row {
  Error error;
  ExitCode exit_code;
  std::string_view name;
};

constexpr Row kRows[] = {
    {Error::CommandLine, ExitCode::CommandLine, "CommandLine"},
    {Error::NotFound, ExitCode::BadInput, "NotFound"},
    {Error::ReadFailed, ExitCode::BadInput, "ReadFailed"},
    {Error::WriteFailed, ExitCode::CannotWrite, "WriteFailed"},
    {Error::Replaced, ExitCode::BadInput, "Replaced"},
    {Error::OutOfMemory, ExitCode::NotSupported, "OutOfMemory"},
    {Error::NotCrease, ExitCode::BadInput, "NotCrease"},
    {Error::VersionTooNew, ExitCode::NotSupported, "VersionTooNew"},
    {Error::Truncated, ExitCode::BadInput, "Truncated"},
    {Error::BadChecksum, ExitCode::BadInput, "BadChecksum"},
    {Error::OverLimit, ExitCode::BadInput, "OverLimit"},
    {Error::BadFormat, ExitCode::BadInput, "BadFormat"},
    {Error::BadValue, ExitCode::BadInput, "BadValue"},
    {Error::NoTriangles, ExitCode::BadInput, "NoTriangles"},
    {Error::NotSupported, ExitCode::NotSupported, "NotSupported"},
    {Error::TargetNotMet, ExitCode::TargetNotMet, "TargetNotMet"},
    {Error::Invalid, ExitCode::Invalid, "Invalid"},
    {Error::Interrupted, ExitCode::Interrupted, "Interrupted"},
};

const Row* find_row(Error error) {
  for (const Row& row : kRows) {
    if (row.error == error) return &row;
  }
  return nullptr;
}

}  // namespace

ExitCode exit_code_of(Error error) {
  const Row* row = find_row(error);
  return row ? row->exit_code : ExitCode::BadInput;
}

std::string_view name_of(Error error) {
  const Row* row = find_row(error);
  return row ? row->name : "Unknown";
}

std::string failure_json(const Failure& failure) {
  return printed({{"error",
                   {{"code", static_cast<int>(failure.error)},
                    {"name", name_of(failure.error)},
                    {"message", failure.message}}},
                  {"exit_status", static_cast<int>(exit_code_of(failure.error))}});
}

std::string printed(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace crease::cli
