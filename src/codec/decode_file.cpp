#include "codec/decode_file.h"

#include "base/bytes.h"
#include "hierarchy/packed_contraction.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

namespace crease {

namespace {

using format::Kind;

class FileDecoder {
 public:
  FileDecoder(std::span<const std::byte> file, const SectionTable& table)
      : file_(file), table_(table) {}

  Result<CreaseFile> run() {
    if (auto failure = decode_schema()) return *failure;
    if (auto failure = decode_names()) return *failure;
    decode_arrays();
    for (std::uint32_t l = 0; l < layer_count_; ++l) {
      if (auto failure = decode_layer(l)) return *failure;
    }
    decode_contractions();
    for (const SectionEntry& entry : table_.entries) {
      if (format::is_of_layer(entry.kind) && entry.layer >= layer_count_) {
        return bad(entry.name() + ": there is no such layer");
      }
    }
    if (Status status = check_progressive_arrays(*arrays_); !status.ok()) {
      return fail(Error::BadFormat, status.failure().message);
    }
    CreaseFile result;
    result.info = describe();
    result.arrays = std::move(arrays_);
    return result;
  }

 private:
  static Failure bad(std::string what) { return fail(Error::BadFormat, std::move(what)); }

  std::optional<Failure> end_of(const ByteReader& in, const char* section) {
    if (!in.truncated() && in.remaining() == 0) return std::nullopt;
    return bad(std::string("section '") + section +
               "': " + (in.truncated() ? "it is too short" : "it is too long"));
  }

  ByteReader section(Kind kind, std::uint32_t layer = 0) const {
    return ByteReader(table_.find(file_, kind, layer));
  }
  std::vector<std::uint32_t> words(Kind kind, std::uint32_t layer = 0) const {
    return section(kind, layer).rest_u32s();
  }
  std::vector<Vec3i> vectors(Kind kind) const {
    ByteReader in = section(kind);
    std::vector<Vec3i> values(in.remaining() / 12);
    for (Vec3i& v : values) {
      for (int i = 0; i < 3; ++i) v[i] = static_cast<std::int32_t>(in.u32());
    }
    return values;
  }

  std::optional<Failure> decode_schema() {
    ByteReader in = section(Kind::Schema);
    for (int i = 0; i < 3; ++i) arrays_->grid.origin[i] = in.f64();
    arrays_->grid.step = in.f64();
    const std::uint8_t placement = in.u8();
    SectionCounts& full = arrays_->full;
    for (std::uint32_t* count : {&full.sn_vertices, &full.nsn_vertices, &full.sn_triangles,
                                 &full.fn_triangles, &full.nsn_triangles}) {
      *count = in.u32();
    }
    arrays_->normal_name = in.text();
    layer_count_ = in.u32();
    if (auto failure = end_of(in, "schema")) return failure;
    if (placement > 1) return bad("section 'schema': unknown placement");
    arrays_->placement = placement == 1 ? Placement::Optimal : Placement::Endpoint;
    if (layer_count_ > table_.entries.size()) return bad("section 'schema': layers are missing");
    return std::nullopt;
  }

  std::optional<Failure> decode_names() {
    ByteReader materials = section(Kind::Materials);
    if (materials.remaining() > 0) {
      const std::uint32_t count = materials.u32();
      for (std::uint32_t i = 0; i < count && !materials.truncated(); ++i) {
        Material material;
        material.name = materials.text();
        for (float& f : material.base_color) {
          f = materials.f32();
          if (!std::isfinite(f)) return bad("section 'materials': a colour is not finite");
        }
        material.base_color_texture = materials.text();
        arrays_->materials.push_back(std::move(material));
      }
    }
    if (auto failure = end_of(materials, "materials")) return failure;
    ByteReader parts = section(Kind::Parts);
    if (parts.remaining() > 0) {
      const std::uint32_t count = parts.u32();
      for (std::uint32_t i = 0; i < count && !parts.truncated(); ++i) {
        arrays_->parts.push_back(parts.text());
      }
    }
    return end_of(parts, "parts");
  }

  void decode_arrays() {
    arrays_->positions = vectors(Kind::Positions);
    arrays_->indices = words(Kind::TriangleIndices);
    ByteReader normals = section(Kind::Normals);
    arrays_->normals.resize(normals.remaining() / 12);
    for (Vec3f& n : arrays_->normals) {
      for (int i = 0; i < 3; ++i) n[i] = normals.f32();
    }
    arrays_->fn_normals = words(Kind::FnNormals);
    arrays_->nsn_normals = words(Kind::NsnNormals);
    arrays_->material_of_triangle = words(Kind::MaterialOfTriangle);
    arrays_->part_of_triangle = words(Kind::PartOfTriangle);
  }

  std::optional<Failure> decode_layer(std::uint32_t l) {
    ByteReader in = section(Kind::Layer, l);
    ProgressiveLayer layer;
    layer.name = in.text();
    const std::uint8_t role = in.u8(), interpolation = in.u8(), storage = in.u8();
    layer.dimension = in.u32();
    if (auto failure = end_of(in, "layer")) return failure;
    if (role == 0 || role > 3 || interpolation > 2 || storage > 2) {
      return bad("layer '" + layer.name + "': unknown role, interpolation or storage");
    }
    layer.role = static_cast<AttributeRole>(role);
    layer.interpolation = static_cast<Interpolation>(interpolation);
    layer.storage = static_cast<ProgressiveLayer::Storage>(storage);
    layer.values = section(Kind::LayerValues, l).rest_f32s();
    layer.row_of_triangle = words(Kind::LayerRows, l);
    layer.indices = words(Kind::LayerIndices, l);
    arrays_->layers.push_back(std::move(layer));
    return std::nullopt;
  }

  void decode_contractions() {
    PackedContractions& p = arrays_->contractions;
    p.kept = words(Kind::Kept);
    p.headers = words(Kind::Headers);
    p.deltas = vectors(Kind::Deltas);
    ByteReader wide = section(Kind::Wide);
    p.wide.resize(wide.remaining() / 24);
    for (WideCounts& w : p.wide) {
      for (std::uint32_t* count :
           {&w.lost.sn_vertices, &w.lost.nsn_vertices, &w.lost.sn_triangles, &w.lost.fn_triangles,
            &w.lost.nsn_triangles, &w.corner_changes}) {
        *count = wide.u32();
      }
    }
    p.corners = words(Kind::Corners);
    p.own = words(Kind::Own);
    p.block_ends = words(Kind::BlockEnds);
    p.blocks = words(Kind::Blocks);
    ByteReader errors = section(Kind::Errors);
    p.errors.resize(errors.remaining() / 20);
    for (ErrorStep& step : p.errors) {
      step.applied = errors.u32();
      for (float* f :
           {&step.error.surface, &step.error.line, &step.error.degrees, &step.error.texture}) {
        *f = errors.f32();
      }
    }
  }

  FileInfo describe() const {
    FileInfo info;
    info.version = table_.version;
    info.bytes = file_.size();
    for (const SectionEntry& entry : table_.entries) {
      info.sections.push_back({entry.name(), entry.offset, entry.bytes});
    }
    ByteReader bands = section(Kind::Bands);
    while (bands.remaining() > 0) {
      FileInfo::Band band;
      band.patches = bands.u32();
      band.contractions = bands.u32();
      band.triangles_after = bands.u32();
      band.surface_error = bands.f32();
      info.bands.push_back(band);
    }
    return info;
  }

  std::span<const std::byte> file_;
  const SectionTable& table_;
  std::shared_ptr<ProgressiveArrays> arrays_ = std::make_shared<ProgressiveArrays>();
  std::uint32_t layer_count_ = 0;
};

}  // namespace

Result<CreaseFile> decode_file(std::span<const std::byte> bytes, const DecodeLimits& limits,
                               Checksums checksums) {
  const Result<SectionTable> table = decode_section_table(bytes, limits, checksums);
  if (!table.ok()) return table.failure();
  if (checksums == Checksums::Verify) {
    for (const SectionEntry& entry : table->entries) {
      if (std::string wrong = checksum_failure(bytes, entry); !wrong.empty()) {
        return fail(Error::BadChecksum, std::move(wrong));
      }
    }
  }
  return FileDecoder(bytes, *table).run();
}

Result<CreaseFile> decode_crease(std::span<const std::byte> bytes, const DecodeLimits& limits) {
  return decode_file(bytes, limits, Checksums::Verify);
}

}  // namespace crease
