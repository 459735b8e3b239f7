// A command of the tool: its options, and a function that does the work and returns what to print.
//
//   Command command = add_build(app, common);   // registers `crease build`
//   Result<Report> report = command.run();      // after app.parse()
#pragma once

#include "crease/result.h"

#include <CLI/CLI.hpp>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

namespace crease::cli {

using Json = nlohmann::ordered_json;

// What every command has.
struct Common {
  bool json = false;   // one object on standard output, nothing else there
  bool quiet = false;  // nothing on standard error but failures
  int threads = 0;     // 0: all
};

// What a command has to say. Printed by main(): `json` with --json, else `text`.
struct Report {
  Json json = Json::object();
  std::string text;             // lines for people
  bool text_is_answer = false;  // printed in spite of --quiet: the command was asked for it
  // Set when the work was done and its result is short of what was asked: the reason, and the exit
  // status that goes with it.
  Error short_of{};
  std::string shortfall;
  bool is_printed = false;  // the command did that itself, as others wait for it
};

struct Command {
  CLI::App* app = nullptr;
  std::function<Result<Report>()> run;
};

Command add_build(CLI::App& app, const Common& common);
Command add_info(CLI::App& app, const Common& common);
Command add_extract(CLI::App& app, const Common& common);
Command add_compare(CLI::App& app, const Common& common);
Command add_render(CLI::App& app, const Common& common);
Command add_report(CLI::App& app, const Common& common);
Command add_validate(CLI::App& app, const Common& common);
Command add_generate(CLI::App& app, const Common& common);
Command add_serve(CLI::App& app, const Common& common);
Command add_view(CLI::App& app, const Common& common);

}  // namespace crease::cli
