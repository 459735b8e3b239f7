#include "codec/encode_container.h"

#include "codec/checksum.h"
#include "codec/container.h"
#include "codec/container_rules.h"

#include <limits>
#include <utility>

namespace crease {

namespace {

constexpr std::size_t kMaxCount16 = std::numeric_limits<std::uint16_t>::max();

void encode_reserved(ByteWriter& out, int count) {
  for (int i = 0; i < count; ++i) out.u8(0);
}

void encode_errors(ByteWriter& out, const LevelError& e) {
  for (float f : {e.surface, e.line, e.degrees, e.texture}) out.f32(f);
}

void encode_error_codes(ByteWriter& out, const LevelError& e) {
  for (float f : {e.surface, e.line, e.degrees, e.texture}) out.u16(format::code_of_error(f));
}

std::vector<std::byte> encode_materials(const std::vector<Material>& materials) {
  ByteWriter out;
  if (!materials.empty()) out.u32(static_cast<std::uint32_t>(materials.size()));
  for (const Material& material : materials) {
    out.text(material.name);
    out.f32s(material.base_color);
    out.text(material.base_color_texture);
  }
  return out.take();
}

std::vector<std::byte> encode_parts(const std::vector<std::string>& parts) {
  ByteWriter out;
  if (!parts.empty()) out.u32(static_cast<std::uint32_t>(parts.size()));
  for (const std::string& part : parts) out.text(part);
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
  for (const BandFacts& band : facts.bands) {
    out.u32(band.patches);
    out.u64(band.contractions);
    out.u64(band.triangles_after);
    encode_errors(out, band.error);
  }
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
                                               std::span<const std::uint32_t> dependency_counts) {
  const ModelFacts& facts = content.facts;
  if (std::string wrong = broken_rule_of_content(content, dependency_counts.size());
      !wrong.empty()) {
    return fail(Error::Invalid, wrong);
  }
  ContainerWriter writer(sink);
  writer.block_count_ = static_cast<std::uint32_t>(dependency_counts.size());
  writer.band_count_ = static_cast<std::uint16_t>(facts.bands.size());
  ByteWriter lists;
  encode_layers_and_bands(lists, facts);
  const std::uint32_t page_count = format::page_count(writer.block_count_);
  const std::uint64_t head_bytes =
      format::kFixedHeadBytes + (content.images.empty() ? 0 : format::kImageHeadBytes) +
      lists.bytes().size() + std::uint64_t(page_count) * format::kPageReferenceBytes;
  if (head_bytes > format::kMaxHeadBytes) {
    return fail(Error::OverLimit, "layers, bands and pages take " + std::to_string(head_bytes) +
                                      " bytes of a head that has room for " +
                                      std::to_string(format::kMaxHeadBytes));
  }
  writer.head_bytes_ = static_cast<std::uint32_t>(head_bytes);
  writer.position_ = head_bytes;

  for (std::uint32_t p = 0; p < page_count; ++p) {
    const std::uint32_t count = format::blocks_of_page(writer.block_count_, p);
    std::uint64_t dependencies = 0;
    for (std::uint32_t n : dependency_counts.subspan(p * kBlocksPerPage, count)) dependencies += n;
    const std::uint64_t bytes = format::page_bytes(count, dependencies);
    if (bytes > format::kMaxPageBytes) {
      return fail(Error::OverLimit, "page " + std::to_string(p) + ": " +
                                        std::to_string(dependencies) + " dependencies");
    }
    writer.pages_.push_back({0, static_cast<std::uint32_t>(bytes)});
  }

  ByteWriter& head = writer.head_;
  head.u32(writer.block_count_);
  head.u16(writer.band_count_);
  head.u16(static_cast<std::uint16_t>(facts.layers.size()));
  head.u64(facts.vertex_count);
  head.u64(facts.triangle_count);
  for (int i = 0; i < 3; ++i) head.f64(facts.grid.origin[i]);
  head.f64(facts.grid.step);
  head.u8(facts.grid_bits);
  head.u8(static_cast<std::uint8_t>(facts.up));
  encode_reserved(head, 2);
  head.u32(static_cast<std::uint32_t>(content.parts.size()));
  const std::vector<std::byte> materials = encode_materials(content.materials);
  writer.parts_ = encode_parts(content.parts);
  using Section = const std::vector<std::byte>*;
  writer.images_ = content.images;
  writer.image_list_ = encode_image_list(content.images);
  std::vector<Section> sections = {&materials, &writer.parts_, &content.tables};
  if (!content.images.empty()) sections.push_back(&writer.image_list_);
  for (const Section section : sections) {
    head.u64(section->size());
    head.u64(section->empty() ? 0 : checksum(*section));
  }
  if (!content.images.empty()) {
    std::uint64_t bytes = 0;
    for (const ImageFile& image : content.images) bytes += image.bytes->size();
    head.u64(bytes);
  }
  for (const Section section : {Section(&materials), &content.tables}) {
    if (Status status = writer.write_section(*section); !status.ok()) return status.failure();
  }
  head.append(lists.bytes());
  if (page_count > 0) writer.begin_page();
  return writer;
}

Status ContainerWriter::write_section(std::span<const std::byte> bytes) {
  const std::uint64_t offset = position_;
  position_ += bytes.size();
  return bytes.empty() ? Status(Done{}) : sink_->write(offset, bytes);
}

void ContainerWriter::begin_page() {
  const std::uint32_t page = page_of(BlockId{next_});
  pages_[page].offset = position_;
  position_ += pages_[page].bytes;
  const std::uint64_t without = format::page_bytes(format::blocks_of_page(block_count_, page), 0);
  dependency_limit_ = static_cast<std::uint32_t>((pages_[page].bytes - without) / 4);
  dependency_count_ = 0;
  entries_ = {};
  dependencies_ = {};
}

Status ContainerWriter::add(const BlockFacts& block, std::span<const BlockId> dependencies,
                            std::span<const std::byte> payload) {
  const auto refused = [this](const std::string& why) {
    return fail(Error::Invalid, "block " + std::to_string(next_) + ": " + why);
  };
  if (next_ == block_count_) return refused("more blocks than announced");
  if (std::string wrong = broken_rule(block, band_count_); !wrong.empty()) return refused(wrong);
  if (std::string wrong = broken_rule(BlockId{next_}, dependencies); !wrong.empty()) {
    return refused(wrong);
  }
  if (payload.size() > std::numeric_limits<std::uint32_t>::max()) return refused("4 GiB or more");
  const bool last_of_page = next_ + 1 == block_count_ || (next_ + 1) % kBlocksPerPage == 0;
  const std::size_t left = dependency_limit_ - dependency_count_;
  if (dependencies.size() > left || (last_of_page && dependencies.size() != left)) {
    return refused("its page has not as many dependencies as announced");
  }
  if (Status status = sink_->write(position_, payload); !status.ok()) return status;
  position_ += payload.size();

  dependency_count_ += static_cast<std::uint32_t>(dependencies.size());
  for (BlockId id : dependencies) dependencies_.u32(static_cast<std::uint32_t>(id));
  entries_.u64(checksum(payload));
  entries_.u32(static_cast<std::uint32_t>(payload.size()));
  entries_.u32(block.decoded_bytes);
  entries_.u16(block.band);
  entries_.u16(0);  // reserved
  entries_.u32(block.patch);
  for (int i = 0; i < 3; ++i) entries_.u32(static_cast<std::uint32_t>(block.center[i]));
  for (std::uint32_t n :
       {block.radius, block.splits, block.vertices, block.triangles_coarse, block.triangles_fine}) {
    entries_.u32(n);
  }
  encode_error_codes(entries_, block.coarse);
  encode_error_codes(entries_, block.fine);
  entries_.u32(dependency_count_);

  if (last_of_page) {
    if (Status status = finish_page(); !status.ok()) return status;
  }
  ++next_;
  if (last_of_page && next_ < block_count_) begin_page();
  return Done{};
}

Status ContainerWriter::finish_page() {
  const std::uint32_t page = page_of(BlockId{next_});
  ByteWriter body, out;
  body.u32(page);
  body.u32(dependency_count_);
  body.append(entries_.bytes());
  body.append(dependencies_.bytes());
  out.u64(checksum(body.bytes()));
  out.append(body.bytes());
  return sink_->write(pages_[page].offset, out.bytes());
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
  out.u16(images_.empty() ? format::kContainerVersion : format::kVersionWithImages);
  out.u16(0);  // flags
  out.u32(head_bytes_);
  out.u64(position_);
  out.u64(checksum(out.bytes(), head_.bytes()));
  out.append(head_.bytes());
  return sink_->write(0, out.bytes());
}

}  // namespace crease
