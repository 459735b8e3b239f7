#include "cli/output.h"

#include "cli/console.h"
#include "cli/fields.h"
#include "crease/write_file.h"

#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <system_error>

namespace crease::cli {

namespace {

// ".obj, .ply, .stl or .glb"
std::string in_words(std::span<const std::string_view> endings) {
  std::string words;
  for (std::size_t i = 0; i < endings.size(); ++i) {
    if (i > 0) words += i + 1 < endings.size() ? ", " : " or ";
    words += endings[i];
  }
  return words;
}

}  // namespace

std::string ending_of(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  for (char& c : ending) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return ending;
}

Status check_ending(const std::filesystem::path& output, std::span<const std::string_view> endings,
                    std::string_view what) {
  const std::string ending = ending_of(output);
  const bool is_known = std::ranges::find(endings, ending) != endings.end();
  if (is_known || (ending.empty() && endings.size() == 1)) return Done{};
  return fail(Error::NotSupported,
              output.string() + ": " + std::string(what) + " written as " + in_words(endings));
}

namespace {

Status check_is_no_input(const std::filesystem::path& output,
                         std::span<const std::filesystem::path> inputs) {
  for (const std::filesystem::path& input : inputs) {
    std::error_code error;  // one of them is not there
    if (std::filesystem::equivalent(output, input, error)) {
      return fail(Error::CommandLine,
                  output.string() + ": is an input, which is never written over");
    }
  }
  return Done{};
}

}  // namespace

Status check_place(const std::filesystem::path& output,
                   std::span<const std::filesystem::path> inputs) {
  const Status fine = check_is_no_input(output, inputs);
  return fine.ok() ? check_writable(output) : fine;
}

bool is_standard_output(const std::filesystem::path& output) {
  struct stat ours, other;  // std::filesystem::equivalent() knows no pipes
  return ::fstat(STDOUT_FILENO, &ours) == 0 && ::stat(output.c_str(), &other) == 0 &&
         ours.st_dev == other.st_dev && ours.st_ino == other.st_ino;
}

Status check_output(const std::filesystem::path& output, std::span<const std::string_view> endings,
                    std::string_view what, std::span<const std::filesystem::path> inputs) {
  const Status known = check_ending(output, endings, what);
  return known.ok() ? check_place(output, inputs) : known;
}

Result<ExportReport> write_mesh(const Mesh& mesh, const std::filesystem::path& output,
                                const Common& common, const WriteOptions& options) {
  for (const std::filesystem::path& file : files_of_export(mesh, output)) {
    const Status fine = check_is_no_input(file, options.inputs);
    if (!fine.ok()) return fine.failure();
  }
  Result<ExportReport> written = export_mesh(mesh, output);
  if (!written.ok()) return written;
  const std::vector<std::string>& lost = options.lost;
  written->left_out.insert(written->left_out.end(), lost.begin(), lost.end());
  for (const std::string& line : lines_of(*written, output)) log(common, line);
  return written;
}

}  // namespace crease::cli
