#include "codec/decode_container.h"

#include "base/bytes.h"
#include "codec/band_coder.h"
#include "codec/container.h"
#include "codec/container_rules.h"
#include "codec/file_version.h"
#include "codec/range_decoder.h"
#include "codec/text_coder.h"

#include <algorithm>
#include <utility>

namespace crease {

namespace {

// Of memory, that names of parts take: to decode them, and each beside its letters.
constexpr std::uint64_t kCoderBytes = 1u << 20, kNameBytes = 64;

Failure bad_head(const std::string& what) {
  return fail(Error::BadFormat, "head: " + what);
}

std::uint8_t decode_reserved(ByteReader& in, int count) {
  std::uint8_t any = 0;
  for (int i = 0; i < count; ++i) any |= in.u8();
  return any;
}

// An unknown one is none of the enumeration, for broken_rule().
AttributeCoding decode_coding(std::uint8_t code) {
  constexpr AttributeCoding kUnknown{0xff};
  const auto coding = static_cast<AttributeCoding>(code);
  if (coding == AttributeCoding::Lattice) return kUnknown;
  return code == format::kLatticeCode ? AttributeCoding::Lattice : coding;
}

LayerSchema decode_layer(ByteReader& in, std::uint8_t& reserved) {
  LayerSchema layer;
  layer.name = in.text();
  layer.role = static_cast<AttributeRole>(in.u8());
  layer.interpolation = static_cast<Interpolation>(in.u8());
  layer.dimension = in.u8();
  layer.coding = decode_coding(in.u8());
  layer.bits = in.u8();
  reserved |= decode_reserved(in, 3);
  return layer;
}

// False: they are none.
bool decode_bands(ByteReader& in, std::uint16_t count, ModelFacts& facts) {
  const std::uint32_t bytes = in.u32();
  if (bytes > in.remaining()) return false;
  codec::RangeDecoder decoder(in.take(bytes));
  codec::BandCoder<codec::RangeDecoder> coder(decoder, facts.triangle_count);
  for (std::uint16_t b = 0; b < count && !coder.failed(); ++b)
    facts.bands.push_back(coder.code({}));
  return !coder.failed() && decoder.bytes_left() == 0;
}

// From the file's end: images, their list, names of parts. False: they are longer than the file.
bool place_last_sections(BlockFileHead& head) {
  std::uint64_t end = head.file_bytes;
  for (FileRange* range : {&head.images, &head.image_list.range, &head.parts.range}) {
    if (range->bytes > end - head.head_bytes) return false;
    end -= range->bytes;
    range->offset = end;
  }
  return true;
}

// What is behind the first 32 bytes. `in` ends where the head does.
Result<BlockFileHead> decode_head_fields(ByteReader& in, BlockFileHead head, bool has_images) {
  ModelFacts& facts = head.facts;
  head.block_count = in.u32();
  const std::uint16_t band_count = in.u16(), layer_count = in.u16();
  facts.vertex_count = in.u64();
  facts.triangle_count = in.u64();
  for (int i = 0; i < 3; ++i) facts.grid.origin[i] = in.f64();
  facts.grid.step = in.f64();
  facts.grid_bits = in.u8();
  facts.up = static_cast<UpAxis>(in.u8());
  std::uint8_t reserved = decode_reserved(in, 2);
  head.part_count = in.u32();
  std::uint64_t end = head.head_bytes, left = head.file_bytes - end;
  std::vector<BlockFileHead::Section*> sections = {&head.materials, &head.parts, &head.tables};
  if (has_images) sections.push_back(&head.image_list);
  for (BlockFileHead::Section* section : sections) {
    section->range.bytes = in.u64();
    section->checksum = in.u64();
    if (section->range.bytes > left) return bad_head("names or tables that end after the file");
    left -= section->range.bytes;
    if (section->range.bytes == 0 && section->checksum != 0) {
      return bad_head("the checksum of what is absent");
    }
  }
  for (auto* section : {&head.materials, &head.tables}) {
    section->range.offset = end;
    end += section->range.bytes;
  }
  if (has_images) {
    head.images.bytes = in.u64();
    const bool has_none = head.image_list.range.bytes == 0 && head.images.bytes == 0;
    const bool may_have_none = format::layout_of(head.version) >= format::kLayoutWithSurfaces;
    if (has_none ? !may_have_none : head.image_list.range.bytes == 0 || head.images.bytes == 0) {
      return bad_head("a list of images without images, or none where there must be one");
    }
  }
  if (!place_last_sections(head)) return bad_head("images that end after the file");
  const std::uint64_t blocks_end = head.parts.range.offset;
  if ((head.part_count == 0) != (head.parts.range.bytes == 0)) {
    return bad_head("there are not as many names as parts");
  }
  const std::uint32_t pages = format::page_count(head.block_count);
  if (std::uint64_t(layer_count) * format::kLayerBytes +
          std::uint64_t(pages) * format::kPageReferenceBytes >
      in.remaining()) {
    return bad_head("too short for its layers and pages");
  }
  for (std::uint16_t l = 0; l < layer_count; ++l) {
    facts.layers.push_back(decode_layer(in, reserved));
  }
  if (band_count > 0 && !decode_bands(in, band_count, facts)) {
    return bad_head("its bands do not end with their bytes");
  }
  for (std::uint32_t p = 0; p < pages; ++p) {
    FileRange page;
    page.offset = in.u64();
    page.bytes = in.u32();
    const std::uint32_t least =
        format::fixed_page_bytes(format::blocks_of_page(head.block_count, p));
    const std::string name = "page " + std::to_string(p);
    if (p == 0 ? page.offset != end : page.offset < end) {
      return bad_head(name + " is not behind what comes before it");
    }
    if (page.bytes < least || page.bytes > format::kMaxPageBytes) {
      return bad_head(name + " has a size that no such page has");
    }
    if (page.offset > blocks_end || page.bytes > blocks_end - page.offset) {
      return bad_head(name + " ends after the file");
    }
    end = page.offset + page.bytes;
    head.pages.push_back(page);
  }
  if (in.truncated() || in.remaining() != 0) return bad_head("it is not as long as it says");
  if (reserved != 0) return bad_head("a reserved byte is not 0");
  if (pages == 0 && end != blocks_end) return bad_head("bytes behind a file without blocks");
  if (std::string wrong = broken_rule(facts); !wrong.empty()) return bad_head(wrong);
  return head;
}

}  // namespace

Result<BlockFileHead> decode_head(std::span<const std::byte> start, std::uint64_t size,
                                  Checksums checksums) {
  const Result<std::uint16_t> version = decode_version(start);
  if (!version.ok()) return version.failure();
  if (*version < format::kContainerLayout) {
    return fail(Error::NotSupported,
                "version " + std::to_string(*version) +
                    " is a layout from before the first release; build the file again");
  }
  const auto cut = [] {
    return fail(Error::Truncated, std::string("it ends within the head") + kBuildAgain);
  };
  ByteReader in(start);
  in.u64();  // the magic
  in.u32();  // version and flags
  BlockFileHead head;
  head.version = *version;
  head.head_bytes = in.u32();
  head.file_bytes = in.u64();
  const std::uint64_t told = in.u64();
  if (in.truncated()) return cut();
  const bool has_images = format::layout_of(*version) >= format::kLayoutWithImages;
  const std::uint32_t least = format::kFixedHeadBytes + (has_images ? format::kImageHeadBytes : 0);
  if (head.head_bytes < least || head.head_bytes > format::kMaxHeadBytes ||
      head.head_bytes > head.file_bytes) {
    return bad_head("its size at byte 12");
  }
  if (head.head_bytes > start.size()) return cut();
  const auto fields = start.first(head.head_bytes).subspan(format::kHeadStartBytes);
  if (checksums == Checksums::Verify &&
      checksum(start.first(format::kHeadChecksumOffset), fields) != told) {
    return fail(Error::BadChecksum, std::string("head at byte 0: checksum differs") + kBuildAgain);
  }
  if (size > head.file_bytes) {
    return fail(Error::BadFormat, "bytes behind its end" + at_byte(head.file_bytes));
  }
  ByteReader rest(fields);
  return decode_head_fields(rest, std::move(head), has_images);
}

Result<std::vector<Material>> decode_materials(std::span<const std::byte> bytes,
                                               std::uint16_t layout) {
  std::vector<Material> materials;
  if (bytes.empty()) return materials;
  const auto bad = [](const std::string& what) {
    return fail(Error::BadFormat, "materials: " + what);
  };
  ByteReader in(bytes);
  const std::uint32_t count = in.u32();
  if (count == 0 || count > in.remaining() / format::kMinMaterialBytes) {
    return bad("their number is not as many as there are");
  }
  materials.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    Material material;
    material.name = in.text();
    for (float& f : material.base_color) f = in.f32();
    material.base_color_texture = in.text();
    if (layout >= format::kLayoutWithSurfaces) {
      material.alpha_cutoff = in.f32();
      const std::uint8_t flags = in.u8();
      const bool may_blend = layout >= format::kLayoutWithBlending;
      const int known = format::kDoubleSided | (may_blend ? format::kBlended : 0);
      if ((flags & ~known) != 0) return bad("a reserved flag");
      material.double_sided = (flags & format::kDoubleSided) != 0;
      material.is_blended = (flags & format::kBlended) != 0;
    }
    if (std::string wrong = broken_rule(material); !wrong.empty()) return bad(wrong);
    materials.push_back(std::move(material));
  }
  if (in.truncated() || in.remaining() != 0) return bad("they do not end with their bytes");
  return materials;
}

Result<std::vector<std::string>> decode_parts(std::span<const std::byte> bytes, std::uint32_t count,
                                              std::uint64_t max_bytes) {
  std::vector<std::string> parts;
  if (bytes.empty()) return parts;
  const auto bad = [](const std::string& what) {
    return fail(Error::BadFormat, "part names: " + what);
  };
  ByteReader in(bytes);
  const std::uint64_t letters = in.u64();
  if (in.truncated()) return bad("they end too early");
  const std::uint64_t taken = bytes.size() + kCoderBytes + kNameBytes * std::uint64_t(count);
  if (taken > max_bytes || letters > max_bytes - taken) {
    return fail(Error::OverLimit, "part names: they take more than the limit of " +
                                      std::to_string(max_bytes) + " bytes");
  }
  codec::RangeDecoder decoder(in.take(in.remaining()));
  codec::TextCoder<codec::RangeDecoder> coder(decoder);
  std::uint64_t left = letters;
  for (std::uint32_t i = 0; i < count; ++i) {
    parts.push_back(coder.code({}, static_cast<std::size_t>(left)));
    if (coder.failed()) return bad("name " + std::to_string(i) + " is not one");
    left -= parts.back().size();
  }
  if (left != 0 || decoder.bytes_left() > 0) return bad("they do not end with their bytes");
  return parts;
}

}  // namespace crease
