// crease validate: every checksum and every invariant of a file, and those of the hierarchy over
// it.
#include "cli/command.h"
#include "cli/console.h"
#include "cli/model.h"
#include "cli/text.h"
#include "cli/view.h"
#include "crease/file.h"

#include <filesystem>
#include <fstream>
#include <memory>
#include <vector>

namespace crease::cli {

namespace {

struct ValidateArguments {
  std::filesystem::path file;
  bool file_only = false;
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

// Fills `found` where all is well.
Status check_model(const ModelHierarchy& model, Json& found) {
  const MeshHierarchy& hierarchy = *model.hierarchy;
  const Status sound = check_hierarchy(hierarchy);
  if (!sound.ok()) return sound;
  const Status full = check_leaves(hierarchy, model.maps, model.full);
  if (!full.ok()) return full;
  const Result<HardEdges> edges = check_hard_edges(hierarchy);
  if (!edges.ok()) return edges.failure();
  found = {{"splits", hierarchy.vertices.split_count()},
           {"bytes", hierarchy_bytes(hierarchy).total()},
           {"hard_edges",
            {{"count", edges->count},
             {"soft_at_one_end", edges->soft_at_one_end},
             {"soft_at_both_ends", edges->soft_at_both_ends}}}};
  return Done{};
}

// This first .crease holds levels alone, so the hierarchy is made from it as extract --view does.
Status validate_hierarchy(const ValidateArguments& options, const Common& common, Json& found,
                          std::vector<std::string>& problems) {
  const Stopwatch watch;
  const Result<ModelHierarchy> model = load_hierarchy(options.file, {}, common);
  if (!model.ok()) {
    if (model.failure().error == Error::NoTriangles) return Done{};
    return model.failure();
  }
  const Status sound = check_model(*model, found);
  if (sound.ok()) {
    found["seconds"] = watch.seconds();
  } else {
    problems.push_back("hierarchy: " + sound.failure().message);
  }
  return Done{};
}

Result<Report> run_validate(const ValidateArguments& options, const Common& common) {
  const Stopwatch watch;
  const Result<std::vector<std::byte>> bytes = read_bytes(options.file);
  if (!bytes.ok()) return bytes.failure();
  if (!is_crease_file(options.file)) {
    return fail(
        Error::NotCrease,
        options.file.string() + ": is no .crease file; crease info says what a mesh file holds");
  }
  std::vector<std::string> problems = validate_crease(*bytes);
  if (interrupted()) return interrupted_failure();
  Json hierarchy;
  if (problems.empty() && !options.file_only) {
    const Status done = validate_hierarchy(options, common, hierarchy, problems);
    if (!done.ok()) return done.failure();
  }
  if (interrupted()) return interrupted_failure();

  Report report;
  report.json = {{"ok", problems.empty()},
                 {"errors", problems},
                 {"bytes", bytes->size()},
                 {"hierarchy", hierarchy},
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

Command add_validate(CLI::App& app, const Common& common) {
  auto options = std::make_shared<ValidateArguments>();
  CLI::App* command = app.add_subcommand(
      "validate", "every checksum and every invariant of a .crease file and its hierarchy");
  command->add_option("FILE", options->file, "the .crease file")->required();
  command->add_flag("--file-only", options->file_only,
                    "not the hierarchy, which is made from the full resolution and takes as long "
                    "as a build");
  command->footer("Example:\n  crease validate bunny.crease --json");
  return {command, [options, &common] { return run_validate(*options, common); }};
}

}  // namespace crease::cli
