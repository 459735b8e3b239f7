// crease serve: the files of a folder over HTTP, until Ctrl-C.
#include "cli/command.h"
#include "cli/console.h"
#include "cli/number_check.h"
#include "cli/text.h"
#include "crease/file_server.h"

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

namespace crease::cli {

namespace {

struct ServeArguments {
  std::filesystem::path folder;
  FileServerOptions server;
  std::string limit;  // empty: none
  int delay_ms = 0;
};

// Now, since whoever started us waits for the address.
void print_address(const FileServer& server, const ServeArguments& options, const Common& common) {
  if (common.json) {
    const Json json = {{"url", server.url()},
                       {"host", options.server.host},
                       {"port", server.port()},
                       {"folder", options.folder.string()}};
    std::printf("%s\n", json.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
  } else {
    std::printf("%s: %s (Ctrl-C ends)\n", options.folder.string().c_str(), server.url().c_str());
  }
  std::fflush(stdout);
}

Result<Report> run_serve(ServeArguments options, const Common& common) {
  if (!options.limit.empty()) {
    const Result<double> rate = parse_rate(options.limit);
    if (!rate.ok()) return rate.failure();
    options.server.bytes_per_second = *rate;
  }
  options.server.delay = std::chrono::milliseconds(options.delay_ms);
  options.server.on_request = [&common](const ServedRequest& request) {
    const std::string asked =
        request.method + " " + request.path + (request.range.empty() ? "" : " " + request.range);
    log(common, std::to_string(request.status) + " " + without_controls(asked) + ": " +
                    in_bytes(request.bytes));
  };
  const Result<std::unique_ptr<FileServer>> server =
      FileServer::start(options.folder, options.server);
  if (!server.ok()) return server.failure();
  print_address(**server, options, common);
  while (!interrupted()) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  Report report;
  report.is_printed = true;
  report.short_of = Error::Interrupted;
  report.shortfall = "interrupted; nothing is served any more";
  return report;
}

}  // namespace

Command add_serve(CLI::App& app, const Common& common) {
  auto options = std::make_shared<ServeArguments>();
  CLI::App* command = app.add_subcommand(
      "serve",
      "the files of a folder over HTTP with byte ranges, until Ctrl-C; for this machine, "
      "not for the internet");
  command->add_option("DIR", options->folder, "the folder; nothing outside of it is served")
      ->required();
  command->add_option("--host", options->server.host, "address to listen at")
      ->type_name("NAME")
      ->capture_default_str();
  command->add_option("--port", options->server.port, "0: any that is free, which is printed")
      ->type_name("N")
      ->capture_default_str();
  command->add_flag("--follow-symlinks", options->server.follow_symlinks,
                    "symbolic links are refused otherwise");
  command
      ->add_option("--limit", options->limit,
                   "as a line that lets so much through a second: 20Mbit, 2.5MB")
      ->type_name("RATE");
  command->add_option("--delay", options->delay_ms, "pause before each answer")
      ->type_name("MS")
      ->check(number_from(0, 60'000));
  command->footer(
      "Examples:\n  crease serve models --port 8080\n"
      "  crease serve models --limit 20Mbit --delay 40");
  return {command, [options, &common] { return run_serve(*options, common); }};
}

}  // namespace crease::cli
