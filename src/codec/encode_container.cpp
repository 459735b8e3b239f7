#include "codec/encode_container.h"

#include "codec/band_coder.h"
#include "codec/checksum.h"
#include "codec/container.h"
#include "codec/container_rules.h"
#include "codec/encode_page.h"
#include "codec/range_encoder.h"
#include "codec/text_coder.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

namespace crease {

namespace {

constexpr std::size_t kMaxCount16 = std::numeric_limits<std::uint16_t>::max();

void encode_reserved(ByteWriter& out, int count) {
  for (int i = 0; i < count; ++i) out.u8(0);
}

std::uint16_t layout_for(const std::vector<Material>& materials, bool has_images) {
  std::uint16_t layout = has_images ? format::kLayoutWithImages : format::kContainerLayout;
  for (const Material& m : materials) {
    if (m.alpha_cutoff > 0 || m.double_sided)
      layout = std::max(layout, format::kLayoutWithSurfaces);
    if (m.is_blended) layout = format::kLayoutWithBlending;
  }
  return layout;
}

std::vector<std::byte> encode_materials(const std::vector<Material>& materials,
                                        std::uint16_t layout) {
  ByteWriter out;
  if (!materials.empty()) out.u32(static_cast<std::uint32_t>(materials.size()));
  for (const Material& material : materials) {
    out.text(material.name);
    out.f32s(material.base_color);
    out.text(material.base_color_texture);
    if (layout < format::kLayoutWithSurfaces) continue;
    out.f32(material.alpha_cutoff);
    out.u8(static_cast<std::uint8_t>((material.double_sided ? format::kDoubleSided : 0) |
                                     (material.is_blended ? format::kBlended : 0)));
  }
  return out.take();
}

std::vector<std::byte> encode_parts(const std::vector<std::string>& parts) {
  if (parts.empty()) return {};
  std::uint64_t letters = 0;
  codec::RangeEncoder encoder;
  codec::TextCoder<codec::RangeEncoder> coder(encoder);
  for (const std::string& part : parts) {
    coder.code(part, part.size());
    letters += part.size();
  }
  ByteWriter out;
  out.u64(letters);
  out.append(encoder.finish());
  return out.take();
}

std::vector<std::byte> encode_image_list(const std::vector<ImageFile>& images) {
  ByteWriter out;
  if (!images.empty()) out.u32(static_cast<std::uint32_t>(images.size()));
  for (const ImageFile& image : images) {
    out.text(image.name);
    out.u64(image.bytes->size());
    out.u64(checksum(*image.bytes));
  }
  return out.take();
}

std::string broken_rule_of_images(const std::vector<ImageFile>& images) {
  std::vector<std::string_view> names;
  for (const ImageFile& image : images) {
    if (image.bytes == nullptr || image.bytes->empty()) return "one without bytes";
    names.push_back(image.name);
  }
  return broken_rule(std::move(names));
}

void encode_layers_and_bands(ByteWriter& out, const ModelFacts& facts) {
  for (const LayerSchema& layer : facts.layers) {
    out.text(layer.name);
    out.u8(static_cast<std::uint8_t>(layer.role));
    out.u8(static_cast<std::uint8_t>(layer.interpolation));
    out.u8(layer.dimension);
    out.u8(layer.coding == AttributeCoding::Lattice ? format::kLatticeCode
                                                    : static_cast<std::uint8_t>(layer.coding));
    out.u8(layer.bits);
    encode_reserved(out, 3);
  }
  codec::RangeEncoder encoder;
  codec::BandCoder<codec::RangeEncoder> coder(encoder, facts.triangle_count);
  for (const BandFacts& band : facts.bands) coder.code(band);
  if (facts.bands.empty()) return;
  const std::vector<std::byte> bands = encoder.finish();
  out.u32(static_cast<std::uint32_t>(bands.size()));
  out.append(bands);
}

std::string broken_rule_of_content(const ContainerContent& content, std::size_t block_count) {
  if (std::string wrong = broken_rule(content.facts); !wrong.empty()) return wrong;
  for (const Material& material : content.materials) {
    if (std::string wrong = broken_rule(material); !wrong.empty()) return "materials: " + wrong;
  }
  if (std::string wrong = broken_rule_of_images(content.images); !wrong.empty())
    return "images: " + wrong;
  if (content.facts.layers.size() > kMaxCount16) return "too many layers";
  if (content.facts.bands.size() > kMaxCount16) return "too many bands";
  if (block_count > std::numeric_limits<std::uint32_t>::max()) return "too many blocks";
  return {};
}

}  // namespace

Result<ContainerWriter> ContainerWriter::begin(ByteSink& sink, const ContainerContent& content,
                                               std::size_t block_count) {
  const ModelFacts& facts = content.facts;
  if (std::string wrong = broken_rule_of_content(content, block_count); !wrong.empty()) {
    return fail(Error::Invalid, wrong);
  }
  ContainerWriter writer(sink);
  writer.facts_ = facts;
  writer.block_count_ = static_cast<std::uint32_t>(block_count);
  ByteWriter lists;
  encode_layers_and_bands(lists, facts);
  const std::uint32_t page_count = format::page_count(writer.block_count_);
  writer.layout_ = layout_for(content.materials, !content.images.empty());
  const bool tells_images = writer.layout_ >= format::kLayoutWithImages;
  const std::uint64_t head_bytes =
      format::kFixedHeadBytes + (tells_images ? format::kImageHeadBytes : 0) +
      lists.bytes().size() + std::uint64_t(page_count) * format::kPageReferenceBytes;
  if (head_bytes > format::kMaxHeadBytes) {
    return fail(Error::OverLimit, "layers, bands and pages take " + std::to_string(head_bytes) +
                                      " bytes of a head that has room for " +
                                      std::to_string(format::kMaxHeadBytes));
  }
  writer.head_bytes_ = static_cast<std::uint32_t>(head_bytes);
  writer.position_ = head_bytes;

  ByteWriter& head = writer.head_;
  head.u32(writer.block_count_);
  head.u16(static_cast<std::uint16_t>(facts.bands.size()));
  head.u16(static_cast<std::uint16_t>(facts.layers.size()));
  head.u64(facts.vertex_count);
  head.u64(facts.triangle_count);
  for (int i = 0; i < 3; ++i) head.f64(facts.grid.origin[i]);
  head.f64(facts.grid.step);
  head.u8(facts.grid_bits);
  head.u8(static_cast<std::uint8_t>(facts.up));
  encode_reserved(head, 2);
  head.u32(static_cast<std::uint32_t>(content.parts.size()));
  const std::vector<std::byte> materials = encode_materials(content.materials, writer.layout_);
  writer.parts_ = encode_parts(content.parts);
  using Section = const std::vector<std::byte>*;
  writer.images_ = content.images;
  writer.image_list_ = encode_image_list(content.images);
  std::vector<Section> sections = {&materials, &writer.parts_, &content.tables};
  if (tells_images) sections.push_back(&writer.image_list_);
  for (const Section section : sections) {
    head.u64(section->size());
    head.u64(section->empty() ? 0 : checksum(*section));
  }
  if (tells_images) {
    std::uint64_t bytes = 0;
    for (const ImageFile& image : content.images) bytes += image.bytes->size();
    head.u64(bytes);
  }
  for (const Section section : {Section(&materials), &content.tables}) {
    if (Status status = writer.write_section(*section); !status.ok()) return status.failure();
  }
  head.append(lists.bytes());
  return writer;
}

Status ContainerWriter::write_section(std::span<const std::byte> bytes) {
  const std::uint64_t offset = position_;
  position_ += bytes.size();
  return bytes.empty() ? Status(Done{}) : sink_->write(offset, bytes);
}

Status ContainerWriter::add(const BlockFacts& block, std::span<const BlockId> dependencies,
                            std::span<const std::byte> payload) {
  const auto refused = [this](const std::string& why) {
    return fail(Error::Invalid, "block " + std::to_string(next_) + ": " + why);
  };
  if (next_ == block_count_) return refused("more blocks than announced");
  const BlockId id{next_};
  if (std::string wrong = broken_rule(block, facts_.bands.size()); !wrong.empty()) {
    return refused(wrong);
  }
  if (std::string wrong = broken_rule(id, dependencies); !wrong.empty()) return refused(wrong);
  const std::optional<BlockFacts> facts = rounded_up(block);
  if (!facts) return refused("its sphere is too large");
  if (payload.size() > std::numeric_limits<std::uint32_t>::max()) return refused("4 GiB or more");
  if (dependencies.size() > format::kMaxPageDependencies - page_.dependencies.size()) {
    return refused("too many dependencies for its page");
  }
  if (page_.blocks.empty()) page_.first = id;
  page_.blocks.push_back(
      {id, *facts, 0, static_cast<std::uint32_t>(payload.size()), payload_checksum(payload)});
  page_.dependencies.insert(page_.dependencies.end(), dependencies.begin(), dependencies.end());
  page_.dependency_ends.push_back(static_cast<std::uint32_t>(page_.dependencies.size()));
  payloads_.insert(payloads_.end(), payload.begin(), payload.end());
  ++next_;
  const bool is_last_of_page = next_ == block_count_ || next_ % kBlocksPerPage == 0;
  return is_last_of_page ? write_page() : Done{};
}

// And the blocks behind it.
Status ContainerWriter::write_page() {
  const std::vector<std::byte> bytes = encode_page(page_, page_of(page_.first), facts_);
  if (bytes.size() > format::kMaxPageBytes) {
    return fail(Error::OverLimit, "page " + std::to_string(pages_.size()) + ": too large");
  }
  pages_.push_back({position_, static_cast<std::uint32_t>(bytes.size())});
  for (const std::span<const std::byte> part :
       {std::span(bytes), std::span(std::as_const(payloads_))}) {
    if (Status status = write_section(part); !status.ok()) return status;
  }
  page_ = {};
  payloads_.clear();
  return Done{};
}

Status ContainerWriter::finish() {
  if (next_ != block_count_) {
    return fail(Error::Invalid, std::to_string(next_) + " of " + std::to_string(block_count_) +
                                    " blocks were written");
  }
  for (const std::vector<std::byte>* section : {&parts_, &image_list_}) {
    if (Status status = write_section(*section); !status.ok()) return status;
  }
  for (const ImageFile& image : images_) {
    if (Status status = write_section(*image.bytes); !status.ok()) return status;
  }
  for (const Page& page : pages_) {
    head_.u64(page.offset);
    head_.u32(page.bytes);
  }
  ByteWriter out;
  for (std::uint8_t b : format::kMagic) out.u8(b);
  out.u16(format::version_of(layout_));
  out.u16(0);  // flags
  out.u32(head_bytes_);
  out.u64(position_);
  out.u64(checksum(out.bytes(), head_.bytes()));
  out.append(head_.bytes());
  return sink_->write(0, out.bytes());
}

}  // namespace crease
