// crease validate: every checksum and every invariant of a file, and those of the hierarchy over
// it.
#include "cli/command.h"
#include "cli/console.h"
#include "cli/model.h"
#include "cli/text.h"
#include "cli/view.h"
#include "crease/file.h"

#include <filesystem>
#include <memory>
#include <vector>

namespace crease::cli {

namespace {

struct ValidateArguments {
  std::filesystem::path file;
  bool file_only = false;
};

// Fills `found` where all is well.
Status check_model(const ModelHierarchy& model, Json& found) {
  const MeshHierarchy& hierarchy = *model.hierarchy;
  const Status sound = check_hierarchy(hierarchy);
  if (!sound.ok()) return sound;
  const Status full = check_leaves(hierarchy, model.maps, model.finest);
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

Status validate_hierarchy(const ModelFile& file, Json& found, std::vector<std::string>& problems) {
  const Stopwatch watch;
  const Result<ModelHierarchy> model = load_hierarchy(file, {});
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

// Messages name the file where they come from afar; here it is said once, in front.
std::string without_name(const std::string& message, const std::filesystem::path& file) {
  const std::string name = file.string() + ": ";
  return message.starts_with(name) ? message.substr(name.size()) : message;
}

// Of what is in the file, not of reaching it.
bool is_of_content(Error error) {
  return error == Error::BadFormat || error == Error::BadChecksum || error == Error::Truncated;
}

Result<Report> run_validate(const ValidateArguments& options, const Common& common) {
  const Stopwatch watch;
  if (!is_crease_file(options.file)) {
    std::error_code problem;
    const bool exists = std::filesystem::exists(options.file, problem);
    if (!exists) return fail(Error::NotFound, options.file.string() + ": no such file");
    return fail(
        Error::NotCrease,
        options.file.string() + ": is no .crease file; crease info says what a mesh file holds");
  }
  std::vector<std::string> problems;
  std::error_code unknown;  // of a URL
  std::uint64_t bytes = std::filesystem::file_size(options.file, unknown);
  if (unknown) bytes = 0;
  Json hierarchy;
  const Result<ModelFile> file = open_model(options.file, {}, common);
  if (file.ok()) {
    bytes = file->blocks().source().size();
    problems = validate_crease(file->blocks(), decode_options(common));
  } else if (is_of_content(file.failure().error)) {
    problems.push_back(file.failure().message);
  } else {
    return file.failure();
  }
  if (interrupted()) return interrupted_failure();
  if (problems.empty() && !options.file_only) {
    const Status done = validate_hierarchy(*file, hierarchy, problems);
    if (!done.ok()) return done.failure();
  }
  if (interrupted()) return interrupted_failure();

  Report report;
  report.json = {{"ok", problems.empty()}, {"errors", problems},
                 {"bytes", bytes},         {"bytes_read", file.ok() ? file->bytes_read() : 0},
                 {"hierarchy", hierarchy}, {"seconds", watch.seconds()}};
  report.text_is_answer = true;
  if (problems.empty()) {
    report.text =
        options.file.string() + ": valid, " + in_bytes(bytes) + ", " + in_seconds(watch.seconds());
    return report;
  }
  for (const std::string& problem : problems) {
    if (!report.text.empty()) report.text += "\n";
    report.text += options.file.string() + ": " + without_name(problem, options.file);
  }
  report.short_of = Error::Invalid;
  report.shortfall =
      options.file.string() + ": not valid: " + without_name(problems.front(), options.file);
  return report;
}

}  // namespace

Command add_validate(CLI::App& app, const Common& common) {
  auto options = std::make_shared<ValidateArguments>();
  CLI::App* command = app.add_subcommand(
      "validate", "every checksum and every invariant of a .crease file and its hierarchy");
  command->add_option("FILE", options->file, "the .crease file, or its URL")->required();
  command->add_flag("--file-only", options->file_only,
                    "not the hierarchy, which is made from the full resolution");
  command->footer("Example:\n  crease validate bunny.crease --json");
  return {command, [options, &common] { return run_validate(*options, common); }};
}

}  // namespace crease::cli
