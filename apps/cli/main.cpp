// crease: the command line tool. One file per command; this one parses, prints and exits.
#include "cli/command.h"
#include "cli/console.h"
#include "cli/exit_code.h"
#include "cli/memory_option.h"
#include "cli/number_check.h"
#include "cli/output.h"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace crease::cli {

namespace {

void add_common_options(CLI::App& command, Common& common) {
  command.add_flag("--json", common.json, "one JSON object on standard output, nothing else there");
  command.add_flag("--quiet", common.quiet, "nothing on standard error but failures");
  command.add_option("--threads", common.threads, "how many; 0: all. The result is the same")
      ->type_name("N")
      ->check(number_from(0, 1024))
      ->capture_default_str();
}

// All of it arrived: what a full disk lost shows at the latest now.
int after_printing(ExitCode exit_code) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return static_cast<int>(exit_code);
  std::fprintf(stderr, "crease: standard output cannot be written\n");
  return static_cast<int>(ExitCode::CannotWrite);
}

int print_failure(const Failure& failure, const Common& common) {
  wipe_progress_bar();
  std::fprintf(stderr, "crease: %s\n", failure.message.c_str());
  if (common.json) std::printf("%s\n", failure_json(failure).c_str());
  return after_printing(exit_code_of(failure.error));
}

// What was written, which nothing may be mixed with.
bool goes_to_standard_output(const Report& report) {
  const auto output = report.json.find("output");
  return output != report.json.end() && output->is_string() &&
         is_standard_output(output->get<std::string>());
}

int print_report(Report report, const Common& common) {
  wipe_progress_bar();
  const bool is_short = !report.shortfall.empty();
  if (is_short) report.json["exit_status"] = static_cast<int>(exit_code_of(report.short_of));
  if (report.is_printed) {
    // nothing is left to say
  } else if (common.json) {
    std::printf("%s\n", printed(report.json).c_str());
  } else if (!report.text.empty() && (report.text_is_answer || !common.quiet)) {
    std::FILE* const to = goes_to_standard_output(report) ? stderr : stdout;
    std::fprintf(to, "%s\n", report.text.c_str());
  }
  if (!is_short) return after_printing(ExitCode::Done);
  std::fprintf(stderr, "crease: %s\n", report.shortfall.c_str());
  return after_printing(exit_code_of(report.short_of));
}

Result<Report> run_command(const Command& command) {
  try {
    return command.run();
  } catch (const std::bad_alloc&) {
    std::optional<Failure> failure = spill_failure();
    if (failure) return *std::move(failure);
    return fail(Error::OutOfMemory, "out of memory; crease build has --memory for large models");
  } catch (const std::exception& error) {
    return fail(Error::NotSupported, error.what());
  }
}

// As far as the words tell that cannot be parsed.
bool asks_for_json(std::span<char*> words) {
  return std::ranges::any_of(words, [](const char* word) { return word == std::string("--json"); });
}

Failure parse_failure(const CLI::App& app, const CLI::ParseError& error) {
  if (!app.get_subcommands().empty()) {
    const std::string command = app.get_subcommands().front()->get_name();
    return fail(Error::CommandLine,
                std::string(error.what()) + " (see crease " + command + " --help)");
  }
  const std::vector<std::string> words = app.remaining();
  return fail(Error::CommandLine,
              (words.empty() ? "a command is missing" : "'" + words.front() + "' is no command") +
                  std::string(" (see crease --help)"));
}

int run_main(int argc, char** argv) {
  CLI::App app{"crease: multiresolution triangle meshes that keep their hard and soft edges"};
  app.set_version_flag("--version", "crease " CREASE_VERSION);
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);

  std::signal(SIGXFSZ, SIG_IGN);  // a limit on file sizes fails as a full disk does
  Common common;
  const std::vector<Command> commands = {add_build(app, common),    add_info(app, common),
                                         add_extract(app, common),  add_compare(app, common),
                                         add_render(app, common),   add_report(app, common),
                                         add_validate(app, common), add_generate(app, common),
                                         add_serve(app, common),    add_view(app, common)};
  for (const Command& command : commands) add_common_options(*command.app, common);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help, --version
      app.exit(error);
      return after_printing(ExitCode::Done);
    }
    common.json = asks_for_json(std::span(argv, static_cast<std::size_t>(argc)));
    return print_failure(parse_failure(app, error), common);
  }

  watch_for_interrupts();
  for (const Command& command : commands) {
    if (!command.app->parsed()) continue;
    Result<Report> report = run_command(command);
    return report.ok() ? print_report(*std::move(report), common)
                       : print_failure(report.failure(), common);
  }
  return static_cast<int>(ExitCode::CommandLine);
}

}  // namespace

}  // namespace crease::cli

int main(int argc, char** argv) {
  try {
    return crease::cli::run_main(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "crease: %s\n", error.what());
  }
  return static_cast<int>(crease::cli::ExitCode::NotSupported);
}
