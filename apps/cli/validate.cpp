// crease validate: every checksum and every invariant of a file.
#include "cli/command.h"
#include "cli/console.h"
#include "cli/model.h"
#include "cli/text.h"
#include "crease/file.h"

#include <filesystem>
#include <fstream>
#include <memory>
#include <vector>

namespace crease::cli {

namespace {

struct ValidateArguments {
  std::filesystem::path file;
};

Result<std::vector<std::byte>> read_bytes(const std::filesystem::path& path) {
  std::error_code problem;
  const auto size = std::filesystem::file_size(path, problem);
  if (problem) {
    return fail(
        problem == std::errc::no_such_file_or_directory ? Error::NotFound : Error::ReadFailed,
        path.string() + ": " + problem.message());
  }
  std::vector<std::byte> bytes(size);
  std::ifstream in(path, std::ios::binary);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (!in) return fail(Error::ReadFailed, path.string() + ": cannot be read to its end");
  return bytes;
}

Result<Report> run_validate(const ValidateArguments& options) {
  const Stopwatch watch;
  const Result<std::vector<std::byte>> bytes = read_bytes(options.file);
  if (!bytes.ok()) return bytes.failure();
  if (!is_crease_file(options.file)) {
    return fail(
        Error::NotCrease,
        options.file.string() + ": is no .crease file; crease info says what a mesh file holds");
  }
  const std::vector<std::string> problems = validate_crease(*bytes);
  if (interrupted()) return interrupted_failure();

  Report report;
  report.json = {{"ok", problems.empty()},
                 {"errors", problems},
                 {"bytes", bytes->size()},
                 {"seconds", watch.seconds()}};
  report.text_is_answer = true;
  if (problems.empty()) {
    report.text = options.file.string() + ": valid, " + in_bytes(bytes->size()) + ", " +
                  in_seconds(watch.seconds());
    return report;
  }
  for (const std::string& problem : problems) {
    if (!report.text.empty()) report.text += "\n";
    report.text += options.file.string() + ": " + problem;
  }
  report.short_of = Error::Invalid;
  report.shortfall = options.file.string() + ": not valid: " + problems.front();
  return report;
}

}  // namespace

Command add_validate(CLI::App& app, const Common&) {
  auto options = std::make_shared<ValidateArguments>();
  CLI::App* command =
      app.add_subcommand("validate", "every checksum and every invariant of a .crease file");
  command->add_option("FILE", options->file, "the .crease file")->required();
  command->footer("Example:\n  crease validate bunny.crease --json");
  return {command, [options] { return run_validate(*options); }};
}

}  // namespace crease::cli
