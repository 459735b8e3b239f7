#include "base/assert.h"
#include "base/bytes.h"
#include "codec/checksum.h"
#include "codec/format.h"
#include "crease/file.h"

#include <algorithm>
#include <tuple>

namespace crease {

namespace {

using format::Kind;

struct EncodedSection {
  Kind kind;
  std::uint32_t layer;
  std::vector<std::byte> bytes;
};

class FileEncoder {
 public:
  FileEncoder(const ProgressiveArrays& arrays, std::span<const FileInfo::Band> bands)
      : a_(arrays), bands_(bands) {}

  std::vector<std::byte> run() {
    add_names();
    add_arrays();
    for (std::uint32_t l = 0; l < a_.layers.size(); ++l) add_layer(l);
    add_contractions();
    return join();
  }

 private:
  void add(Kind kind, ByteWriter out, std::uint32_t layer = 0) {
    if (out.bytes().empty()) return;
    sections_.push_back({kind, layer, out.take()});
  }
  void add(Kind kind, std::span<const std::uint32_t> values, std::uint32_t layer = 0) {
    ByteWriter out;
    out.u32s(values);
    add(kind, std::move(out), layer);
  }
  void add(Kind kind, const std::vector<Vec3i>& values) {
    ByteWriter out;
    for (const Vec3i& v : values) {
      for (int i = 0; i < 3; ++i) out.u32(static_cast<std::uint32_t>(v[i]));
    }
    add(kind, std::move(out));
  }

  void add_names() {
    ByteWriter schema;
    for (int i = 0; i < 3; ++i) schema.f64(a_.grid.origin[i]);
    schema.f64(a_.grid.step);
    schema.u8(a_.placement == Placement::Optimal ? 1 : 0);
    for (std::uint32_t count : {a_.full.sn_vertices, a_.full.nsn_vertices, a_.full.sn_triangles,
                                a_.full.fn_triangles, a_.full.nsn_triangles}) {
      schema.u32(count);
    }
    schema.text(a_.normal_name);
    schema.u32(static_cast<std::uint32_t>(a_.layers.size()));
    add(Kind::Schema, std::move(schema));

    ByteWriter materials, parts, bands;
    if (!a_.materials.empty()) materials.u32(static_cast<std::uint32_t>(a_.materials.size()));
    for (const Material& material : a_.materials) {
      materials.text(material.name);
      materials.f32s(material.base_color);
      materials.text(material.base_color_texture);
    }
    add(Kind::Materials, std::move(materials));
    if (!a_.parts.empty()) parts.u32(static_cast<std::uint32_t>(a_.parts.size()));
    for (const std::string& part : a_.parts) parts.text(part);
    add(Kind::Parts, std::move(parts));
    for (const FileInfo::Band& band : bands_) {
      bands.u32(band.patches);
      bands.u32(band.contractions);
      bands.u32(band.triangles_after);
      bands.f32(band.surface_error);
    }
    add(Kind::Bands, std::move(bands));
  }

  void add_arrays() {
    add(Kind::Positions, a_.positions);
    add(Kind::TriangleIndices, a_.indices);
    ByteWriter normals;
    for (const Vec3f& n : a_.normals) {
      for (int i = 0; i < 3; ++i) normals.f32(n[i]);
    }
    add(Kind::Normals, std::move(normals));
    add(Kind::FnNormals, a_.fn_normals);
    add(Kind::NsnNormals, a_.nsn_normals);
    add(Kind::MaterialOfTriangle, a_.material_of_triangle);
    add(Kind::PartOfTriangle, a_.part_of_triangle);
  }

  void add_layer(std::uint32_t l) {
    const ProgressiveLayer& layer = a_.layers[l];
    ByteWriter head, values;
    head.text(layer.name);
    head.u8(static_cast<std::uint8_t>(layer.role));
    head.u8(static_cast<std::uint8_t>(layer.interpolation));
    head.u8(static_cast<std::uint8_t>(layer.storage));
    head.u32(layer.dimension);
    add(Kind::Layer, std::move(head), l);
    values.f32s(layer.values);
    add(Kind::LayerValues, std::move(values), l);
    add(Kind::LayerRows, layer.row_of_triangle, l);
    add(Kind::LayerIndices, layer.indices, l);
  }

  void add_contractions() {
    const PackedContractions& p = a_.contractions;
    add(Kind::Kept, p.kept);
    add(Kind::Headers, p.headers);
    add(Kind::Deltas, p.deltas);
    ByteWriter wide, errors;
    for (const WideCounts& w : p.wide) {
      for (std::uint32_t count : {w.lost.sn_vertices, w.lost.nsn_vertices, w.lost.sn_triangles,
                                  w.lost.fn_triangles, w.lost.nsn_triangles, w.corner_changes}) {
        wide.u32(count);
      }
    }
    add(Kind::Wide, std::move(wide));
    add(Kind::Corners, p.corners);
    add(Kind::Own, p.own);
    add(Kind::BlockEnds, p.block_ends);
    add(Kind::Blocks, p.blocks);
    for (const ErrorStep& step : p.errors) {
      errors.u32(step.applied);
      for (float f :
           {step.error.surface, step.error.line, step.error.degrees, step.error.texture}) {
        errors.f32(f);
      }
    }
    add(Kind::Errors, std::move(errors));
  }

  std::vector<std::byte> join() {
    std::sort(sections_.begin(), sections_.end(),
              [](const EncodedSection& a, const EncodedSection& b) {
                return std::tie(a.kind, a.layer) < std::tie(b.kind, b.layer);
              });
    std::uint64_t offset = format::kHeaderBytes + format::kEntryBytes * sections_.size();
    ByteWriter table;
    for (const EncodedSection& section : sections_) {
      table.u32(static_cast<std::uint32_t>(section.kind));
      table.u32(section.layer);
      table.u64(offset);
      table.u64(section.bytes.size());
      table.u64(checksum(section.bytes));
      offset += section.bytes.size();
    }
    ByteWriter out;
    for (std::uint8_t b : format::kMagic) out.u8(b);
    out.u16(format::kVersion);
    out.u16(0);
    out.u32(static_cast<std::uint32_t>(sections_.size()));
    out.u64(offset);
    CREASE_ASSERT(out.bytes().size() == format::kChecksumOffset);
    out.u64(checksum(out.bytes(), table.bytes()));
    out.append(table.bytes());
    for (EncodedSection& section : sections_) {
      out.append(section.bytes);
      section.bytes = {};
    }
    return out.take();
  }

  const ProgressiveArrays& a_;
  std::span<const FileInfo::Band> bands_;
  std::vector<EncodedSection> sections_;
};

}  // namespace

std::vector<std::byte> encode_crease(const ProgressiveArrays& arrays,
                                     std::span<const FileInfo::Band> bands) {
  return FileEncoder(arrays, bands).run();
}

}  // namespace crease
