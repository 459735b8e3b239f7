#include "cli/model.h"

#include "cli/console.h"
#include "cli/fields.h"
#include "cli/number_check.h"
#include "cli/text.h"
#include "cli/view_blocks.h"
#include "crease/build_progressive_arrays.h"
#include "crease/http_source.h"
#include "crease/threads.h"

#include <algorithm>
#include <cmath>
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
                  "sides whose normals all lie within it get one normal, and so do normals that "
                  "meet at a vertex: exporter noise is no crease")
      ->type_name("DEGREES")
      ->check(number_from(0.0, 180.0))
      ->capture_default_str();
  command
      .add_option("--textures", options.texture_folder,
                  "where images are looked for that are not in the model's own folder, by the last "
                  "part of their path; nothing is read outside of the two")
      ->type_name("DIR")
      ->check(CLI::ExistingDirectory);
}

void add_build_options(CLI::App& command, ReadOptions& options) {
  add_import_options(command, options);
  command
      .add_option("--precision", options.precision,
                  "grid that positions are snapped to: a length (0.001), or bits over the longest "
                  "side (14bits). By default the one that the model's numbers are on, such as "
                  "whole millimetres, so that nothing is rounded, or 24bits. Open borders that "
                  "meet within a step are joined; by default within 22bits, which floats hardly "
                  "tell apart")
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
          "precision of normals: 8 to 16 bits a component (default 12: off by 0.04 degrees at "
          "most), or 4 to 12 an angle with deering, default 6; exact: as they are")
      ->type_name("N|exact");
  command
      .add_option("--normal-coding", options.normal_coding,
                  "how directions become integers: octahedral | deering")
      ->check(CLI::IsMember({"octahedral", "deering"}))
      ->type_name("HOW")
      ->capture_default_str();
  command
      .add_option("--texcoord-bits", options.texcoord_bits,
                  "precision of texture coordinates: 4 to 16 bits over their range, default 14; "
                  "exact: as they are")
      ->type_name("N|exact");
  command
      .add_option("--color-bits", options.color_bits,
                  "precision of colours: 4 to 16 bits over their range, default 10; exact: as they "
                  "are")
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
  if (!options.texture_folder.empty()) import.texture_folder = options.texture_folder;
  if (!options.precision.empty()) {
    Result<Precision> precision = parse_precision(options.precision);
    if (!precision.ok()) return precision.failure();
    import.precision = *precision;
  }
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

void tell_strays(Imported& imported, const Precision& precision) {
  if (precision.length > 0) return;  // the step is as asked for
  const std::optional<Strays> strays = find_strays(imported.mesh);
  if (!strays) return;
  const double step = make_grid(imported.mesh, precision).step;
  const double finest = 1.001 * finest_step(imported.mesh);  // as it is written, in four digits
  const double wanted = std::ldexp(strays->longest_without, -precision.bits_or_default());
  // By default the others have their steps, or the model's own, unless no grid reaches so far.
  const bool is_fine = step <= 1.001 * wanted || (precision.bits == 0 && step > finest);
  if (is_fine) return;
  const bool can_be_had = wanted > finest;
  std::string note =
      grouped(strays->count) + " of " + grouped(imported.mesh.vertex_count()) +
      " vertices are far from all others: the longest side is " + in_length(strays->longest) +
      " with them and " + in_length(strays->longest_without) +
      " without, so positions are on a grid with steps of " + in_length(step) + ". Take them away";
  if (finest < step) {
    note += ", or ask for shorter steps: --precision " + in_length(can_be_had ? wanted : finest);
    note += can_be_had ? ", what the others would have" : ", the finest that there is with them";
  }
  imported.report.notes.push_back(note);
}

bool is_url(const std::filesystem::path& path) {
  const std::string text = path.string();
  const std::size_t scheme = text.find("://");
  return scheme != 0 && scheme != text.npos &&
         std::all_of(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(scheme), [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                  c == '+' || c == '-' || c == '.';
         });
}

bool is_crease_file(const std::filesystem::path& path) {
  if (is_url(path) || path.extension() == ".crease") return true;
  const Result<BlockFile> file = open_crease(path);
  if (file.ok()) return true;
  const Error error = file.failure().error;
  return error != Error::NotCrease && error != Error::NotFound && error != Error::ReadFailed;
}

DecodeOptions decode_options(const Common& common) {
  DecodeOptions options;
  options.for_each = loop_on_threads(common.threads);
  return options;
}

namespace {

// `build`: what it is imported for, or null.
Result<Imported> import_and_report(const std::filesystem::path& path, const ReadOptions& options,
                                   const Common& common, const BuildOptions* build) {
  Result<ImportOptions> import = import_options(options, common);
  if (!import.ok()) return import.failure();
  Result<Imported> imported = import_mesh(path, *import);
  wipe_progress_bar();
  if (imported.ok() && build != nullptr) tell_strays(*imported, build->precision);
  if (imported.ok()) log(common, path.string() + ":\n" + lines_of(imported->report));
  return imported;
}

}  // namespace

ProgressiveMesh Model::levels() const {
  return ProgressiveMesh(build_progressive_arrays(decoded.mesh, decoded.sequence));
}

std::uint16_t finest_band_for(const ModelFacts& facts, std::size_t triangles) {
  std::uint16_t band = 0;
  while (band < facts.bands.size() && facts.bands[band].triangles_after > triangles) ++band;
  return band;
}

// A host was asked for more than the head, a disk is as if it had not been.
ModelFile::ModelFile(BlockFile blocks, std::vector<std::byte> built, const Common& common)
    : built_(std::move(built)),
      blocks_(std::move(blocks)),
      read_to_open_(blocks_.source().bytes_read()),
      bytes_to_open_(is_remote() ? read_to_open_ : blocks_.head().head_bytes),
      common_(&common) {}

bool ModelFile::is_remote() const {
  return is_http_url(blocks_.source().name());
}

std::uint64_t ModelFile::bytes_read() const {
  const std::uint64_t read = blocks_.source().bytes_read() - read_to_open_ + bytes_to_open_;
  if (is_remote()) return read;
  return std::min(read, blocks_.source().size());
}

std::string ModelFile::name() const {
  return std::filesystem::path(blocks_.source().name()).filename().string();
}

Status ModelFile::check_normals() const {
  const std::vector<LayerSchema>& layers = blocks_.facts().layers;
  const auto normals = std::ranges::find(layers, AttributeRole::Normal, &LayerSchema::role);
  if (normals != layers.end()) return Done{};
  return fail(Error::NotSupported, name() + ": has no normals, which all here is about");
}

Result<Model> ModelFile::load(const Detail& detail) const {
  if (const Status shaded = check_normals(); !shaded.ok()) return shaded.failure();
  DecodeOptions options = decode_options(*common_);
  const ModelFacts& facts = blocks_.facts();
  if (detail.triangles) {
    options.finest_band = finest_band_for(facts, *detail.triangles);
    if (detail.is_one_level) options.contracted_bands = 1;
  }
  if (detail.is_mesh_only) options.contracted_bands = 0;
  options.part_names = detail.part_names;
  if (detail.view) options.wants = blocks_for_view(facts, *detail.view);
  const std::uint64_t before = blocks_.source().bytes_read();
  Result<DecodedModel> decoded = decode_model(blocks_, options);
  if (!decoded.ok()) return decoded.failure();
  Model model{*std::move(decoded), blocks_.source().bytes_read() - before};
  model.bytes_read += bytes_to_open_;
  if (interrupted()) return interrupted_failure();
  return model;
}

// A mesh file's images were looked for when it was imported, and a host is not asked for others.
Result<std::vector<ImageFile>> ModelFile::images(std::span<const Material> materials) const {
  const bool has_textures = std::ranges::any_of(
      materials, [](const Material& m) { return !m.base_color_texture.empty(); });
  if (!has_textures) return std::vector<ImageFile>();
  const std::string& name = blocks_.source().name();
  Result<std::vector<ImageFile>> images = blocks_.read_images();
  if (!images.ok() || was_built() || is_remote()) return images;
  std::vector<std::filesystem::path> folders{std::filesystem::path(name).parent_path()};
  if (!texture_folder_.empty()) folders.push_back(texture_folder_);
  for (const std::string& note : find_images(folders, materials, *images)) {
    log(*common_, name + ": " + note);
  }
  return images;
}

namespace {

// Of a .crease: what was asked for as if it were a mesh, and has been decided by its build.
void tell_void_options(const ReadOptions& options, const std::string& name, const Common& common) {
  const ReadOptions none;
  std::string given;
  const auto note = [&](const char* option, bool is_given) {
    if (is_given) given += (given.empty() ? "" : ", ") + std::string(option);
  };
  note("--normals", options.normals != none.normals);
  note("--same-normal", options.same_normal_deg > 0);
  note("--precision", !options.precision.empty());
  note("--placement", options.placement != none.placement);
  note("--normal-coding", options.normal_coding != none.normal_coding);
  note("--normal-bits", !options.normal_bits.empty());
  note("--texcoord-bits", !options.texcoord_bits.empty());
  note("--color-bits", !options.color_bits.empty());
  if (!given.empty())
    log(common, name + ": " + given + " of no effect: its build has decided that");
}

Result<BlockFile> open_crease_or_url(const std::filesystem::path& path) {
  if (!is_url(path)) return open_crease(path);
  if (!is_http_url(path.string())) {
    return fail(Error::NotSupported,
                path.string() + ": only http:// and https:// are read, and files of this machine");
  }
  HttpOptions options;
  options.stopped = interrupted;
  Result<ByteSourcePtr> source = open_http_source(path.string(), options);
  if (!source.ok()) return source.failure();
  return BlockFile::open(*std::move(source));
}

}  // namespace

Result<ModelFile> open_model(const std::filesystem::path& path, const ReadOptions& options,
                             const Common& common) {
  if (is_crease_file(path)) {
    Result<BlockFile> file = open_crease_or_url(path);
    if (!file.ok()) return file.failure();
    tell_void_options(options, path.string(), common);
    ModelFile model(*std::move(file), {}, common);
    model.texture_folder_ = options.texture_folder;
    return model;
  }
  Result<BuildOptions> build = build_options(options, common);
  if (!build.ok()) return build.failure();
  Result<Imported> imported = import_and_report(path, options, common, &*build);
  if (!imported.ok()) return imported.failure();
  log(common, "  not a .crease file: built on the fly (crease build " + path.string() +
                  " -o MODEL.crease does it once)");
  Result<Built> built = build_model(std::move(imported->mesh), *build);
  wipe_progress_bar();
  if (!built.ok()) return built.failure();
  Result<BlockFile> file = BlockFile::open(memory_source(built->file_bytes, path.string()));
  if (!file.ok()) return file.failure();
  ModelFile model(*std::move(file), std::move(built->file_bytes), common);
  model.imported_ = std::move(imported->report);
  return model;
}

Result<Mesh> load_mesh(const std::filesystem::path& path, const ReadOptions& options,
                       const Common& common, ImportReport* report) {
  if (is_crease_file(path)) {
    const Result<ModelFile> file = open_model(path, options, common);
    if (!file.ok()) return file.failure();
    Result<Model> model = file->load({.is_mesh_only = true, .part_names = false});
    if (!model.ok()) return model.failure();
    return std::move(model->decoded.mesh);
  }
  Result<Imported> imported = import_and_report(path, options, common, nullptr);
  if (!imported.ok()) return imported.failure();
  if (report != nullptr) *report = std::move(imported->report);
  return std::move(imported->mesh);
}

}  // namespace crease::cli
