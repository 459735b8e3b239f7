#include "plain_decoder/container.h"

#include "plain_decoder/checksum.h"
#include "plain_decoder/entries.h"
#include "plain_decoder/names.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace plain {

namespace {

constexpr std::uint32_t kBlocksOfPage = 512, kMaxHead = 65'536, kMaxPage = 4'194'304;

// Little-endian numbers, one after the other.
class Reader {
 public:
  explicit Reader(Bytes bytes) : bytes_(std::move(bytes)) {}

  std::uint64_t number(std::size_t bytes) {
    demand(bytes <= left(), "it ends too early");
    std::uint64_t x = 0;
    for (std::size_t i = bytes; i-- > 0;) {
      x = x << 8 | std::to_integer<std::uint64_t>(bytes_[at_ + i]);
    }
    at_ += bytes;
    return x;
  }
  std::uint8_t u8() { return static_cast<std::uint8_t>(number(1)); }
  std::uint16_t u16() { return static_cast<std::uint16_t>(number(2)); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(number(4)); }
  std::uint64_t u64() { return number(8); }
  std::int32_t i32() { return static_cast<std::int32_t>(u32()); }
  float f32() { return std::bit_cast<float>(u32()); }
  double f64() { return std::bit_cast<double>(u64()); }
  std::string text() {
    const std::uint32_t length = u32();
    demand(length <= left(), "a text that ends too late");
    std::string result;
    for (std::uint32_t i = 0; i < length; ++i) result += static_cast<char>(u8());
    return result;
  }
  void reserved(std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; ++i) demand(u8() == 0, "a reserved byte that is not 0");
  }
  Bytes bytes(std::size_t count) {
    demand(count <= left(), "it ends too early");
    const auto begin = bytes_.begin() + static_cast<std::ptrdiff_t>(at_);
    at_ += count;
    return {begin, begin + static_cast<std::ptrdiff_t>(count)};
  }
  std::size_t left() const { return bytes_.size() - at_; }
  void end() const { demand(left() == 0, "bytes behind the end"); }

 private:
  Bytes bytes_;
  std::size_t at_ = 0;
};

Bytes part_of(const Bytes& file, std::uint64_t offset, std::uint64_t bytes) {
  demand(offset <= file.size() && bytes <= file.size() - offset, "it ends after the file");
  const auto begin = file.begin() + static_cast<std::ptrdiff_t>(offset);
  return {begin, begin + static_cast<std::ptrdiff_t>(bytes)};
}

std::uint32_t blocks_of_page(const Head& head, std::size_t page) {
  return std::min(kBlocksOfPage, head.blocks - kBlocksOfPage * static_cast<std::uint32_t>(page));
}

// "Attribute layer".
Layer read_layer(Reader& in) {
  struct Rule {
    int least, most;
    bool directions;
  };
  constexpr std::array<Rule, 4> kRules{
      {{0, 0, false}, {1, 32, false}, {4, 16, true}, {2, 12, true}}};
  Layer layer;
  layer.name = in.text();
  layer.role = in.u8();
  layer.interpolation = in.u8();
  layer.dimension = in.u8();
  const std::uint8_t coding = in.u8();
  demand(coding != 1 && coding <= 4, "an unknown code");
  layer.coding = coding == 4 ? 1 : coding;  // lattices are second below
  layer.bits = in.u8();
  in.reserved(3);
  demand(layer.role <= 3 && layer.interpolation <= 2, "an unknown code");
  demand(layer.dimension >= 1 && layer.dimension <= 4, "a layer's dimension");
  demand(layer.role != 0 || layer.dimension == 3, "normals of another dimension than 3");
  const Rule& rule = kRules[layer.coding];
  demand(layer.bits >= rule.least && layer.bits <= rule.most, "a layer's bits");
  demand(!rule.directions || (layer.dimension == 3 && layer.interpolation == 0),
         "a coding of directions for what is none");
  return layer;
}

Part read_part(Reader& in) {
  const std::uint64_t bytes = in.u64(), checksum = in.u64();
  demand(bytes > 0 || checksum == 0, "the checksum of what is absent");
  return {bytes, checksum};
}

// "Head".
Head read_head(const Bytes& file) {
  constexpr std::array<std::uint8_t, 8> kMagic{0x89, 0x43, 0x52, 0x45, 0x41, 0x53, 0x45, 0x0a};
  Reader start(file);
  for (const std::uint8_t byte : kMagic) demand(start.u8() == byte, "not a file of this kind");
  const std::uint16_t version = start.u16();
  demand(version >= 6 && version <= 13, "none of the versions 6 to 13");
  const int layout = version < 10 ? version : version - 4;
  start.u16();  // flags; below
  Head head;
  head.version = version;
  head.layout = layout;
  head.bytes = start.u32();
  head.file_bytes = start.u64();
  const std::uint64_t told = start.u64();
  demand(head.bytes >= (layout >= 7 ? 168 : 144) && head.bytes <= kMaxHead, "the size of the head");
  const Bytes whole = part_of(file, 0, head.bytes);
  Bytes covered = whole;
  covered.erase(covered.begin() + 24, covered.begin() + 32);
  demand(checksum(covered) == told, "the checksum of the head");
  demand(file.size() == head.file_bytes, "the size of the file");

  Reader in(whole);
  in.number(8);
  in.u16();
  in.reserved(2);
  in.number(4);
  in.number(8);
  in.number(8);
  head.blocks = in.u32();
  const std::uint16_t bands = in.u16(), layers = in.u16();
  head.vertices = in.u64();
  head.triangles = in.u64();
  for (double& x : head.origin) x = in.f64();
  head.step = in.f64();
  head.grid_bits = in.u8();
  head.up = in.u8();
  in.reserved(2);
  head.parts = in.u32();
  head.materials = read_part(in);
  head.part_names = read_part(in);
  head.tables = read_part(in);
  if (layout >= 7) {
    head.image_list = read_part(in);
    head.image_bytes = in.u64();
    demand((head.image_list.bytes > 0) == (head.image_bytes > 0), "a list without images");
    demand(layout >= 8 || head.image_bytes > 0, "layout 7 without images");
  }
  for (int l = 0; l < layers; ++l) head.layers.push_back(read_layer(in));
  if (bands > 0) head.bands = read_bands(in.bytes(in.u32()), bands, head.triangles);
  const std::uint64_t pages = (std::uint64_t(head.blocks) + kBlocksOfPage - 1) / kBlocksOfPage;
  for (std::uint64_t p = 0; p < pages; ++p) {
    const std::uint64_t offset = in.u64();
    head.pages.push_back({offset, in.u32()});
    demand(head.pages.back().bytes <= kMaxPage, "the size of a page");
  }
  in.end();

  demand(std::isfinite(head.step) && head.step > 0, "the grid's step");
  for (const double x : head.origin) {
    demand(std::isfinite(x) && std::abs(x) <= head.step * 0x1p50, "the grid's origin");
  }
  demand(head.grid_bits <= 31, "the grid's bits");
  demand(head.up <= 2, "the axis that points up");
  const auto is_normal = [](const Layer& layer) { return layer.role == 0; };
  demand(std::count_if(head.layers.begin(), head.layers.end(), is_normal) <= 1,
         "two layers of normals");
  return head;
}

Bytes read_part(const Bytes& file, std::uint64_t& offset, const Part& part) {
  Bytes bytes = part_of(file, offset, part.bytes);
  offset += part.bytes;
  demand(bytes.empty() || checksum(bytes) == part.checksum, "the checksum of names or tables");
  return bytes;
}

// "Materials, part names, lattices".
std::vector<Material> read_materials(const Bytes& bytes, int layout) {
  std::vector<Material> materials;
  if (bytes.empty()) return materials;
  Reader in(bytes);
  const std::uint32_t count = in.u32();
  demand(count > 0, "no materials");
  for (std::uint32_t i = 0; i < count; ++i) {
    Material material;
    material.name = in.text();
    for (float& c : material.colour) {
      c = in.f32();
      demand(std::isfinite(c), "a colour that is not finite");
    }
    material.texture = in.text();
    if (layout >= 8) {
      material.cutoff = in.f32();
      demand(std::isfinite(material.cutoff) && material.cutoff >= 0, "a cutoff");
      const int flags = in.u8();
      demand(flags <= (layout == 9 ? 3 : 1), "a reserved flag");
      material.double_sided = flags % 2 == 1;
      material.blended = flags >= 2;
    }
    materials.push_back(material);
  }
  in.end();
  return materials;
}

// "Names".
std::vector<std::string> read_part_names(const Bytes& bytes, std::uint32_t parts) {
  demand(bytes.empty() == (parts == 0), "parts without names");
  if (bytes.empty()) return {};
  Reader in({bytes.begin(), bytes.begin() + std::min<std::ptrdiff_t>(std::ssize(bytes), 8)});
  const std::uint64_t letters = in.u64();
  return read_names(std::span(bytes).subspan(8), parts, letters);
}

Lattice read_lattice(Reader& in) {
  constexpr std::int32_t kMost = 1 << 24;
  Lattice lattice;
  lattice.divisor = in.f32();
  lattice.least = in.i32();
  lattice.greatest = in.i32();
  const std::uint32_t entries = in.u16();
  lattice.grain = in.u16() + 1;
  demand(std::isfinite(lattice.divisor) && lattice.divisor > 0, "a divisor");
  demand(-kMost <= lattice.least && lattice.least <= lattice.greatest && lattice.greatest <= kMost,
         "the codes of a lattice");
  demand(lattice.least % lattice.grain == 0 && lattice.greatest % lattice.grain == 0,
         "ends that are no multiples of the grain");
  for (std::uint32_t i = 0; i < entries; ++i) {
    const float entry = in.f32();
    demand(std::isfinite(entry), "an entry that is not finite");
    demand(i == 0 || lattice.entries.back() < entry, "entries that do not ascend");
    lattice.entries.push_back(entry);
  }
  demand(entries == 0 || std::int64_t(entries - 1) * lattice.grain ==
                             std::int64_t(lattice.greatest) - lattice.least,
         "not an entry for every multiple of the grain");
  if (entries == 0) {
    for (const std::int32_t code : {lattice.least, lattice.greatest}) {
      demand(std::isfinite(float(code) / lattice.divisor), "a value that is not finite");
    }
  }
  return lattice;
}

// Where the blocks end: part names, the list of images and the images are behind them.
std::uint64_t end_of_blocks(const Head& head) {
  std::uint64_t end = head.file_bytes;
  for (const std::uint64_t bytes :
       {head.image_bytes, head.image_list.bytes, head.part_names.bytes}) {
    demand(bytes <= end, "the size of names or images");
    end -= bytes;
  }
  return end;
}

// "Images".
std::vector<ImageOfFile> read_images(const Bytes& file, const Bytes& list, std::uint64_t offset) {
  std::vector<ImageOfFile> images;
  if (list.empty()) return images;
  Reader in(list);
  const std::uint32_t count = in.u32();
  demand(count > 0, "no images");
  for (std::uint32_t i = 0; i < count; ++i) {
    ImageOfFile image;
    image.name = in.text();
    const std::uint64_t bytes = in.u64(), told = in.u64();
    demand(!image.name.empty() && bytes > 0, "an image without a name or bytes");
    for (const ImageOfFile& other : images) demand(other.name != image.name, "a name twice");
    image.bytes = part_of(file, offset, bytes);
    offset += bytes;
    demand(checksum(image.bytes) == told, "the checksum of an image");
    images.push_back(image);
  }
  in.end();
  demand(offset == file.size(), "images that do not end with the file");
  return images;
}

// Reads page p. Its blocks lie behind it, and behind them is the next page or the part names.
void read_page(const Bytes& file, const Head& head, std::size_t p, std::vector<Entry>& entries) {
  const PageReference& reference = head.pages[p];
  const Bytes bytes = part_of(file, reference.offset, reference.bytes);
  Reader in(bytes);
  const std::uint64_t told = in.u64();
  demand(checksum({bytes.begin() + 8, bytes.end()}) == told, "the checksum of a page");
  demand(in.u32() == p, "another page");
  const std::uint32_t dependencies = in.u32(), count = blocks_of_page(head, p);
  demand(dependencies <= 1u << 20, "the number of dependencies");
  std::vector<std::uint32_t> checksums;
  for (std::uint32_t i = 0; i < count; ++i) checksums.push_back(in.u32());
  EntryReader reader{std::span(bytes).subspan(16 + 4 * std::size_t(count)), head};
  std::uint64_t offset = reference.offset + reference.bytes, needed = 0;
  for (const std::uint32_t checksum : checksums) {
    Entry entry = reader.entry();
    demand(entry.band <= head.bands.size(), "a band that there is none of");
    entry.checksum = checksum;
    entry.offset = offset;
    offset += entry.bytes;
    entry.needs = reader.dependencies(static_cast<std::uint32_t>(entries.size()));
    needed += entry.needs.size();
    entries.push_back(entry);
  }
  demand(reader.is_at_end(), "bytes behind the entries");
  demand(needed == dependencies, "dependencies of no block");
  const bool is_last = p + 1 == head.pages.size();
  demand(offset == (is_last ? end_of_blocks(head) : head.pages[p + 1].offset),
         "blocks that do not end where the next page begins");
}

}  // namespace

// "The whole".
Container read_container(const Bytes& file) {
  Container container;
  container.head = read_head(file);
  const Head& head = container.head;
  std::uint64_t offset = head.bytes;
  container.materials = read_materials(read_part(file, offset, head.materials), head.layout);
  container.tables = read_part(file, offset, head.tables);
  std::uint64_t last = end_of_blocks(head);
  demand(offset == (head.pages.empty() ? last : head.pages[0].offset),
         "page 0 is not behind names and tables");
  container.part_names = read_part_names(read_part(file, last, head.part_names), head.parts);
  const Bytes image_list = read_part(file, last, head.image_list);
  container.images = read_images(file, image_list, last);
  for (std::size_t p = 0; p < head.pages.size(); ++p) read_page(file, head, p, container.entries);
  return container;
}

std::vector<std::vector<Lattice>> read_lattices(const std::vector<Layer>& layers,
                                                const Bytes& tables) {
  std::vector<std::vector<Lattice>> lattices(layers.size());
  Reader in(tables);
  for (std::size_t l = 0; l < layers.size(); ++l) {
    if (layers[l].coding != 1) continue;
    for (int k = 0; k < layers[l].dimension; ++k) lattices[l].push_back(read_lattice(in));
  }
  in.end();
  return lattices;
}

Bytes read_payload(const Bytes& file, const Entry& entry) {
  Bytes payload = part_of(file, entry.offset, entry.bytes);
  demand(static_cast<std::uint32_t>(checksum(payload)) == entry.checksum,
         "the checksum of a block");
  return payload;
}

}  // namespace plain
