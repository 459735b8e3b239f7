#include "cli/model.h"

#include "cli/console.h"
#include "cli/report.h"
#include "cli/text.h"
#include "crease/progressive_mesh.h"

#include <array>
#include <fstream>
#include <utility>

namespace crease::cli {

void add_import_options(CLI::App& command, ReadOptions& options) {
  command
      .add_option("--normals", options.normals,
                  "keep | flat | smooth | crease:ANGLE: the file's own, or made from the geometry")
      ->type_name("POLICY")
      ->capture_default_str();
  command
      .add_option("--same-normal", options.same_normal_deg,
                  "normals at one vertex that differ by no more become one: exporter noise is no "
                  "crease")
      ->type_name("DEGREES")
      ->check(CLI::Range(0.0, 180.0))
      ->capture_default_str();
}

void add_build_options(CLI::App& command, ReadOptions& options) {
  add_import_options(command, options);
  command
      .add_option("--precision", options.precision,
                  "grid that positions are snapped to: a length (0.001), or bits over the longest "
                  "side (14bits); default 24bits")
      ->type_name("LENGTH|BITSbits");
  command
      .add_option("--placement", options.placement,
                  "where a contracted vertex stands: optimal | endpoint")
      ->check(CLI::IsMember({"optimal", "endpoint"}))
      ->type_name("WHERE")
      ->capture_default_str();
  command
      .add_option(
          "--normal-bits", options.normal_bits,
          "precision of normals: 8 to 16 bits a component (10: off by 0.16 degrees at most), "
          "or 4 to 12 an angle with deering, default 6; exact, the default: as they are")
      ->type_name("N|exact");
  command
      .add_option("--normal-coding", options.normal_coding,
                  "how directions become integers: octahedral | deering")
      ->check(CLI::IsMember({"octahedral", "deering"}))
      ->type_name("HOW")
      ->capture_default_str();
  command
      .add_option("--texcoord-bits", options.texcoord_bits,
                  "precision of texture coordinates: 4 to 16 bits over their range; exact, the "
                  "default: as they are")
      ->type_name("N|exact");
  command
      .add_option("--color-bits", options.color_bits,
                  "precision of colours: 4 to 16 bits over their range; exact, the default: as "
                  "they are")
      ->type_name("N|exact");
}

namespace {

constexpr int kDeeringBits = 6;  // what G03 uses

Result<AttributePrecision> attribute_precision(const ReadOptions& options) {
  AttributePrecision precision;
  const bool deering = options.normal_coding == "deering";
  if (deering) {
    precision.normal_coding = NormalCoding::Deering;
    precision.normal_bits = kDeeringBits;
  }
  struct Asked {
    const char* option;
    const std::string& text;
    int low, high;
    int& bits;
  };
  for (const Asked& asked :
       {Asked{"--normal-bits", options.normal_bits, deering ? 4 : 8, deering ? 12 : 16,
              precision.normal_bits},
        Asked{"--texcoord-bits", options.texcoord_bits, 4, 16, precision.texcoord_bits},
        Asked{"--color-bits", options.color_bits, 4, 16, precision.color_bits}}) {
    if (asked.text.empty()) continue;
    Result<int> bits = parse_bits(asked.option, asked.text, asked.low, asked.high);
    if (!bits.ok()) return bits.failure();
    asked.bits = *bits;
  }
  return precision;
}

}  // namespace

Result<ImportOptions> import_options(const ReadOptions& options, const Common& common) {
  Result<NormalPolicy> normals = parse_normal_policy(options.normals);
  if (!normals.ok()) return fail(Error::CommandLine, "--normals: " + normals.failure().message);
  ImportOptions import;
  import.normals = *normals;
  import.same_normal_deg = options.same_normal_deg;
  import.progress = progress_bar(common);
  return import;
}

Result<BuildOptions> build_options(const ReadOptions& options, const Common& common) {
  BuildOptions build;
  if (!options.precision.empty()) {
    Result<Precision> precision = parse_precision(options.precision);
    if (!precision.ok()) return precision.failure();
    build.precision = *precision;
  }
  Result<AttributePrecision> attributes = attribute_precision(options);
  if (!attributes.ok()) return attributes.failure();
  build.attributes = *attributes;
  build.simplify.placement =
      options.placement == "endpoint" ? Placement::Endpoint : Placement::Optimal;
  build.simplify.threads = common.threads;
  build.simplify.progress = progress_bar(common);
  return build;
}

bool is_crease_file(const std::filesystem::path& path) {
  if (path.extension() == ".crease") return true;
  std::array<char, 64> head{};
  std::ifstream in(path, std::ios::binary);
  in.read(head.data(), head.size());
  const auto got = static_cast<std::size_t>(in.gcount());
  if (got < head.size()) return false;  // a .crease is longer than this
  const Result<CreaseFile> decoded =
      decode_crease(std::as_bytes(std::span<const char>(head.data(), got)), {});
  return decoded.ok() || decoded.failure().error != Error::NotCrease;
}

namespace {

Result<Imported> import_and_report(const std::filesystem::path& path, const ReadOptions& options,
                                   const Common& common) {
  Result<ImportOptions> import = import_options(options, common);
  if (!import.ok()) return import.failure();
  Result<Imported> imported = import_mesh(path, *import);
  wipe_progress_bar();
  if (imported.ok()) log(common, path.string() + ":\n" + lines_of(imported->report));
  return imported;
}

}  // namespace

Result<Model> load_model(const std::filesystem::path& path, const ReadOptions& options,
                         const Common& common) {
  if (is_crease_file(path)) {
    Result<CreaseFile> file = read_crease(path, {});
    if (!file.ok()) return file.failure();
    return Model{.file = *std::move(file), .built_from = std::nullopt};
  }
  Result<BuildOptions> build = build_options(options, common);
  if (!build.ok()) return build.failure();
  Result<Imported> imported = import_and_report(path, options, common);
  if (!imported.ok()) return imported.failure();
  log(common, "  not a .crease file: built on the fly (crease build " + path.string() +
                  " -o MODEL.crease does it once)");
  Result<Built> built = build_model(std::move(imported->mesh), *build);
  wipe_progress_bar();
  if (!built.ok()) return built.failure();
  Result<CreaseFile> file = decode_crease(built->file_bytes, {});
  if (!file.ok()) return file.failure();
  return Model{.file = *std::move(file), .built_from = std::move(imported->report)};
}

Result<Mesh> load_mesh(const std::filesystem::path& path, const ReadOptions& options,
                       const Common& common) {
  if (is_crease_file(path)) {
    Result<CreaseFile> file = read_crease(path, {});
    if (!file.ok()) return file.failure();
    return ProgressiveMesh(file->arrays).extract();
  }
  Result<Imported> imported = import_and_report(path, options, common);
  if (!imported.ok()) return imported.failure();
  return std::move(imported->mesh);
}

}  // namespace crease::cli
