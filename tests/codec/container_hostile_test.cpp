#include "codec/container.h"
#include "codec/container_files.h"
#include "codec/encode_page.h"
#include "codec/repair_checksums.h"
#include "support/sanitized.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <new>
#include <random>

namespace {

std::size_t largest_allocation = 0;

}  // namespace

// The tests below ask how much memory a call wanted.
[[gnu::noinline]] void* operator new(std::size_t size) {
  largest_allocation = std::max(largest_allocation, size);
  void* memory = std::malloc(std::max<std::size_t>(size, 1));
  if (memory == nullptr) std::abort();
  return memory;
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return operator new(size);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace crease {
namespace {

using Bytes = std::vector<std::byte>;

Bytes small_file() {
  return bytes_of(random_file(3, 4, 24));
}

Bytes small_file_with_images() {
  WrittenFile file = random_file(3, 4, 24);
  file.content.images = some_images();
  return bytes_of(file);
}

// Where the head says that pages lie.
BlockFileHead head_of(const Bytes& bytes) {
  return *decode_head(bytes, bytes.size(), Checksums::Ignore);
}

// The failure of opening and reading all of it; none: empty message.
Failure failure_of(const Bytes& bytes, const BlockFileLimits& limits = {}) {
  const Result<BlockFile> file = BlockFile::open(memory_source(bytes), limits);
  if (!file.ok()) return file.failure();
  const std::vector<std::string> wrong = file->validate();
  return wrong.empty() ? Failure{} : fail(Error::Invalid, wrong.front());
}

void put_u32(Bytes& bytes, std::uint64_t at, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) {
    bytes[static_cast<std::size_t>(at) + i] = std::byte(value >> (8 * i) & 0xff);
  }
}

TEST_CASE("every flipped bit of a file of blocks is noticed") {
  for (const Bytes& whole : {small_file(), small_file_with_images()}) {
    REQUIRE(failure_of(whole).message.empty());
    for (std::size_t bit = 0; bit < 8 * whole.size(); bit += kHarmStep) {
      Bytes flipped = whole;
      flipped[bit / 8] ^= std::byte(1 << (bit % 8));
      CAPTURE(bit);
      REQUIRE(!failure_of(flipped).message.empty());
    }
  }
}

TEST_CASE("bytes behind the end of a file of blocks are refused") {
  Bytes longer = small_file();
  longer.push_back({});
  CHECK(failure_of(longer).error == Error::BadFormat);
}

// Cuts the file and asks for every block, those that are there and the next one.
void check_prefix(const Bytes& whole, const WrittenFile& file, const std::vector<BlockEntry>& all,
                  std::size_t cut) {
  CAPTURE(cut);
  const Bytes part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(cut));
  const Result<BlockFile> got = BlockFile::open(memory_source(part));
  const BlockFileHead head = head_of(whole);
  REQUIRE(got.ok() == (cut >= head.head_bytes));
  if (!got.ok()) {
    REQUIRE(got.failure().error == (cut == 0 ? Error::NotCrease : Error::Truncated));
    return;
  }
  std::uint32_t expected = 0;
  while (expected < all.size() && all[expected].offset + all[expected].bytes <= cut &&
         head.pages[page_of(BlockId{expected})].offset +
                 head.pages[page_of(BlockId{expected})].bytes <=
             cut) {
    ++expected;
  }
  const Result<std::uint32_t> complete = got->complete_blocks();
  REQUIRE(complete.ok());
  REQUIRE(*complete == expected);
  if (expected > 0) {  // then the names are there as well
    REQUIRE(got->read_materials().ok());
    REQUIRE(got->read_tables().ok());
    const auto last = got->read_block(all[expected - 1]);
    REQUIRE(last.ok());
    REQUIRE((*last == file.blocks[expected - 1].payload));
  }
  if (expected == all.size()) return;
  const Result<DirectoryPage> page = got->read_page(page_of(BlockId{expected}));
  const Error error =
      page.ok() ? got->read_block(all[expected]).failure().error : page.failure().error;
  REQUIRE(error == Error::Truncated);
}

std::vector<BlockEntry> entries_of(const Bytes& whole) {
  std::vector<BlockEntry> all;
  const Result<BlockFile> file = BlockFile::open(memory_source(whole));
  for (std::uint32_t p = 0; p < file->page_count(); ++p) {
    const DirectoryPage page = *file->read_page(p);
    all.insert(all.end(), page.blocks.begin(), page.blocks.end());
  }
  return all;
}

TEST_CASE("a file cut anywhere opens from its head on and tells which blocks are there") {
  const WrittenFile few = random_file(3, 5, 24);
  const Bytes small = bytes_of(few);
  const std::vector<BlockEntry> small_entries = entries_of(small);
  for (std::size_t cut = 0; cut <= small.size(); ++cut) {
    check_prefix(small, few, small_entries, cut);
  }
  const WrittenFile many = random_file(4, 1100, 5);
  const Bytes large = bytes_of(many);
  const std::vector<BlockEntry> large_entries = entries_of(large);
  std::vector<std::size_t> cuts;
  for (const FileRange& page : head_of(large).pages) {
    const auto at = static_cast<std::size_t>(page.offset);
    for (std::size_t near : {at - 1, at, at + 1}) cuts.push_back(near);
    const auto end = static_cast<std::size_t>(page.offset + page.bytes);
    for (std::size_t near : {end - 1, end, end + 1, end + 300}) cuts.push_back(near);
  }
  std::mt19937_64 random(1);
  for (int i = 0; i < 200; ++i) cuts.push_back(random() % large.size());
  for (std::size_t cut : cuts) {
    check_prefix(large, many, large_entries, std::min(cut, large.size()));
  }
}

TEST_CASE("a harmed page is named, and the others are read") {
  const Bytes whole = bytes_of(random_file(5, 2000, 30));
  const BlockFileHead head = head_of(whole);
  REQUIRE(head.pages.size() == 4);
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 100; ++trial) {
    const auto p = static_cast<std::uint32_t>(random() % head.pages.size());
    const FileRange& page = head.pages[p];
    Bytes harmed = whole;
    for (std::uint64_t i = 0; i < 1 + random() % 5; ++i) {
      harmed[static_cast<std::size_t>(page.offset + random() % page.bytes)] ^=
          std::byte(1 + random() % 255);
    }
    const Result<BlockFile> file = BlockFile::open(memory_source(harmed, "town.crease"));
    REQUIRE(file.ok());
    for (std::uint32_t other = 0; other < head.pages.size(); ++other) {
      if (other != p) REQUIRE(file->read_page(other).ok());
    }
    const Result<DirectoryPage> got = file->read_page(p);
    if (harmed == whole) continue;  // two changes that undo each other
    REQUIRE(!got.ok());
    CHECK(got.failure().error == Error::BadChecksum);
    CHECK(got.failure().message.starts_with("town.crease: page " + std::to_string(p) + " at byte " +
                                            std::to_string(page.offset) + ": checksum differs"));
  }
}

TEST_CASE("a harmed block or section is named with its byte") {
  const Bytes whole = bytes_of(random_file(5, 600, 30));
  for (const BlockEntry& entry : entries_of(whole)) {
    if (entry.bytes == 0) continue;
    Bytes harmed = whole;
    harmed[static_cast<std::size_t>(entry.offset) + entry.bytes / 2] ^= std::byte(4);
    const Result<BlockFile> file = BlockFile::open(memory_source(harmed));
    REQUIRE(file.ok());
    const auto got = file->read_block(entry);
    REQUIRE(!got.ok());
    CHECK(got.failure().message ==
          "block " + std::to_string(index_of(entry.id)) + " at byte " +
              std::to_string(entry.offset) +
              ": checksum differs; the file was cut or changed, build it again");
  }
  const BlockFileHead head = head_of(whole);
  const std::pair<FileRange, const char*> sections[] = {{head.materials.range, "materials"},
                                                        {head.parts.range, "part names"},
                                                        {head.tables.range, "model tables"}};
  for (const auto& [range, name] : sections) {
    Bytes harmed = whole;
    harmed[static_cast<std::size_t>(range.offset)] ^= std::byte(1);
    CHECK(failure_of(harmed).message.starts_with(std::string(name) + " at byte " +
                                                 std::to_string(range.offset)));
  }
}

// The largest piece of what decoding any names of parts takes.
constexpr std::size_t kNamesTable = 1u << 18;

// Of a file that says `value` at `at` behind valid checksums; it must be refused without taking the
// memory that it asks for.
Failure failure_of_lie(const Bytes& whole, std::uint64_t at, std::uint32_t value) {
  Bytes harmed = whole;
  put_u32(harmed, at, value);
  repair_checksums(harmed);
  largest_allocation = 0;
  Failure failure = failure_of(harmed);
  CHECK(largest_allocation <= std::max<std::size_t>(20 * whole.size(), kNamesTable));
  CHECK(!failure.message.empty());
  return failure;
}

TEST_CASE("hostile counts are refused without the memory that they ask for") {
  const Bytes whole = small_file();
  const BlockFileHead head = head_of(whole);
  const std::uint64_t page = head.pages[0].offset;
  struct Lie {
    const char* what;
    std::uint64_t at;
    std::uint32_t value;
  };
  const Lie lies[] = {
      {"head bytes", 12, 0xffffffff},
      {"head bytes", 12, 65'536},
      {"head bytes", 12, 0},
      {"file bytes, low half", 16, 0xffffffff},
      {"file bytes, high half", 20, 0xffffffff},
      {"blocks", 32, 0xffffffff},
      {"blocks", 32, 512},
      {"blocks", 32, 513},
      {"blocks", 32, 0},
      {"bands and layers", 36, 0xffffffff},
      {"bytes of materials", 96, 0xffffffff},
      {"bytes of materials, high half", 100, 0xffffffff},
      {"bytes of part names", 112, 0xffffffff},
      {"bytes of tables, high half", 132, 0x7fffffff},
      {"length of a layer's name", 144, 0xffffffff},
      {"offset of the page, high half", head.head_bytes - 8, 0xffffffff},
      {"bytes of the page", head.head_bytes - 4, 0xffffffff},
      {"bytes of the page", head.head_bytes - 4, 4u << 20},
      {"materials", head.materials.range.offset, 0xffffffff},
      {"part names", head.parts.range.offset, 0xffffffff},
      {"page", page + 8, 1},
      {"dependencies", page + 12, 0xffffffff},
      {"dependencies", page + 12, format::kMaxPageDependencies},
      {"dependencies", page + 12, 0},
  };
  for (const Lie& lie : lies) {
    CAPTURE(lie.what);
    CAPTURE(lie.value);
    const Failure failure = failure_of_lie(whole, lie.at, lie.value);
    CHECK(failure.message.find("checksum differs") == std::string::npos);
  }
}

TEST_CASE("what a file says of its images is looked at behind the checksums") {
  const Bytes whole = small_file_with_images();
  const BlockFileHead head = head_of(whole);
  const std::uint64_t list = head.image_list.range.offset;
  const std::uint64_t first = list + 4, second = first + 4 + 9 + 16;  // "brick.png"
  struct Lie {
    std::uint64_t at;
    std::uint32_t value;
    const char* message;
  };
  const Lie lies[] = {
      {8, 6, "head"},  // then its layers begin elsewhere
      {144, 0xffffffff, "head: names or tables that end after the file"},
      {144, 0, "head"},
      {160, 0xffffffff, "head: images that end after the file"},
      {160, 0, "head: a list of images without images"},
      {160, 40, "behind"},
      {list, 0xffffffff, "list of images: their number is not as many as there are"},
      {list, 0, "list of images: their number is not as many as there are"},
      {list, 1, "list of images: it does not end with its bytes"},
      {first, 0xffffffff, "list of images"},
      {first + 4 + 9, 0, "list of images: one ends after the others"},
      {first + 4 + 9, 42, "list of images: one ends after the others"},
      {first + 4 + 9, 39, "list of images: bytes of no image"},
      {first + 4 + 9 + 4, 1, "list of images: one ends after the others"},
      {second + 4 + 8, 2, "list of images: one ends after the others"},
  };
  for (const Lie& lie : lies) {
    CAPTURE(lie.message);
    CAPTURE(lie.at);
    const Failure failure = failure_of_lie(whole, lie.at, lie.value);
    CAPTURE(failure.message);
    if (lie.value != 40) CHECK(failure.message.find(lie.message) != std::string::npos);
  }
  // Names that are one name would make a texture's image depend on the reader.
  WrittenFile twice = random_file(3, 4, 24);
  twice.content.images = {some_image("a", 3), some_image("a", 4)};
  CHECK(bytes_of(twice).empty());
  twice.content.images = {some_image("", 3)};
  CHECK(bytes_of(twice).empty());
  twice.content.images = {some_image("a", 0)};
  CHECK(bytes_of(twice).empty());

  Bytes harmed = whole;
  harmed[static_cast<std::size_t>(head.images.offset) + 40] ^= std::byte{1};
  CHECK(failure_of(harmed).message ==
        "image 'wood.jpg' at byte " + std::to_string(head.images.offset + 40) +
            ": checksum differs; the file was cut or changed, build it again");
  const BlockFileLimits few{.max_bytes = 39};
  const Result<BlockFile> file = BlockFile::open(memory_source(whole), few);
  REQUIRE(file.ok());
  const ImageEntry entry{"brick.png", {head.images.offset, 40}, 0};
  CHECK(file->read_image(entry).failure().error == Error::OverLimit);
}

TEST_CASE("what the container promises is looked at behind the checksums") {
  const Bytes whole = small_file();
  const BlockFileHead head = head_of(whole);
  const std::uint64_t page = head.pages[0].offset;
  struct Lie {
    std::uint64_t at;
    std::uint32_t value;
    const char* message;
  };
  const Lie lies[] = {
      {8, 0x00010006, "version or flags at byte 8"},
      {8, 7, "head"},         // whose layers begin later
      {80, 0, "head: grid"},  // the step's lower half; its upper one follows
      {88, 32, "head: grid: more than 31 bits"},
      {89, 0x03000003, "head: unknown axis for up"},  // and three parts
      {89, 0x03000100, "head: a reserved byte is not 0"},
      {92, 0x7fffffff, "part names: they take more than the limit"},
      {92, 0, "head: there are not as many names as parts"},
      {92, 2, "part names: they do not end with their bytes"},
      {144 + 4 + 6, 4, "head: layer 0: unknown role"},
      {144 + 4 + 6, 0x01030000, "head: layer 0: unknown coding"},
      {page + 8, 1, "page 0 at byte"},
      {page + 12, 0, "its dependencies are out of range"},
  };
  for (const Lie& lie : lies) {
    CAPTURE(lie.message);
    Bytes harmed = whole;
    put_u32(harmed, lie.at, lie.value);
    if (lie.at == 80) put_u32(harmed, 84, 0);
    repair_checksums(harmed);
    const std::string message = failure_of(harmed).message;
    CAPTURE(message);
    CHECK(message.find(lie.message) != std::string::npos);
  }
}

// The file, which has one page, with what `change` makes of that.
template <class Change>
Bytes with_page(const Bytes& whole, const Change& change) {
  const BlockFileHead head = head_of(whole);
  const FileRange range = head.pages[0];
  DirectoryPage page = *decode_page(repair::part(whole, range), head, 0, Checksums::Ignore);
  change(page);
  const Bytes written = encode_page(page, 0, head.facts);
  const auto at = whole.begin() + static_cast<std::ptrdiff_t>(range.offset);
  Bytes changed(whole.begin(), at);
  changed.insert(changed.end(), written.begin(), written.end());
  changed.insert(changed.end(), at + static_cast<std::ptrdiff_t>(range.bytes), whole.end());
  put_u32(changed, head.head_bytes - 4, static_cast<std::uint32_t>(written.size()));
  put_u32(changed, 16, static_cast<std::uint32_t>(changed.size()));
  repair_checksums(changed);
  return changed;
}

TEST_CASE("what a page says of its blocks is looked at behind the checksums") {
  const Bytes whole = small_file();
  const auto failure_with = [&whole](auto change) {
    return failure_of(with_page(whole, change)).message;
  };
  const auto says = [&failure_with](auto change, const char* message) {
    const std::string got = failure_with(change);
    CAPTURE(got);
    CHECK(got.find(message) != std::string::npos);
  };
  CHECK(failure_with([](DirectoryPage&) {}).empty());
  CHECK(with_page(whole, [](DirectoryPage&) {}) == whole);
  says([](DirectoryPage& p) { p.blocks[0].facts.band = 3; }, "block 0: there is no such band");
  says([](DirectoryPage& p) { p.blocks[1].facts.coarse.line = HUGE_VALF; },
       "block 1: what no writer writes");
  says([](DirectoryPage& p) { p.blocks[0].facts.fine.line = 1e30f; },
       "block 0: its fine end has the greater error");
  says([](DirectoryPage& p) { p.blocks[3].bytes = 0xffffffff; },
       "block 3: it ends where another page is");
  says([](DirectoryPage& p) { ++p.blocks[3].bytes; }, "block 3: it ends where another page is");
  says([](DirectoryPage& p) { p.blocks[2].bytes = 0; },
       "its blocks do not end where the next page begins");
  says([](DirectoryPage& p) { p.blocks.pop_back(); }, "page 0");
  says(
      [](DirectoryPage& p) {
        p.dependencies = {BlockId{0}, BlockId{3}};
        p.dependency_ends = {0, 1, 1, 2};
      },
      "block 3: it needs a block that is not before it");
  // Bytes behind what it says: so many that they are not the zeros which an encoder leaves out.
  Bytes longer = whole;
  const BlockFileHead head = head_of(whole);
  const auto end = static_cast<std::ptrdiff_t>(head.pages[0].offset + head.pages[0].bytes);
  longer.insert(longer.begin() + end, 5, std::byte{1});
  put_u32(longer, head.head_bytes - 4, static_cast<std::uint32_t>(head.pages[0].bytes + 5));
  put_u32(longer, 16, static_cast<std::uint32_t>(longer.size()));
  repair_checksums(longer);
  CHECK(failure_of(longer).message.ends_with("its entries do not end with it"));
}

TEST_CASE("random words under right checksums give a failure or a file that is said again") {
  std::mt19937_64 random(1);
  const Bytes whole = small_file();
  std::size_t accepted = 0;
  for (int trial = 0; trial < (kSanitized ? 3000 : 20'000); ++trial) {
    Bytes harmed = whole;
    for (std::uint64_t i = 0; i < 1 + random() % 3; ++i) {
      const auto word = static_cast<std::uint32_t>(random() % 3 == 0 ? random() : random() % 20);
      put_u32(harmed, 12 + random() % (whole.size() - 15), word);
    }
    repair_checksums(harmed);
    const Result<BlockFile> file = BlockFile::open(memory_source(harmed));
    if (!file.ok() || !file->validate().empty()) continue;
    ++accepted;
    REQUIRE(is_written_again(*file));
  }
  CHECK(accepted > 100);
}

TEST_CASE("a limit of memory is kept") {
  WrittenFile written = random_file(3, 400, 24);
  written.content.parts.clear();  // which take a MiB
  const Bytes whole = bytes_of(written);
  const FileRange page = head_of(whole).pages[0];
  const std::size_t dependencies =
      BlockFile::open(memory_source(whole))->read_page(0)->dependencies.size();
  const std::uint64_t needed = page.bytes + 160 * 400 + 16 * dependencies;
  CHECK(failure_of(whole, {.max_bytes = needed}).message.empty());
  CHECK(failure_of(whole, {.max_bytes = needed - 1}).error == Error::Invalid);
  const Result<BlockFile> file = BlockFile::open(memory_source(whole), {.max_bytes = 10});
  REQUIRE(file.ok());
  CHECK(file->read_page(0).failure().error == Error::OverLimit);
  CHECK(file->read_materials().failure().error == Error::OverLimit);
  for (const BlockEntry& entry : entries_of(whole)) {
    CHECK(file->read_block(entry).ok() == (entry.bytes <= 10));
  }
}

TEST_CASE("opening and reading pages and names takes no more memory than is stated") {
  WrittenFile file = random_file(8, 1000, 3);
  file.content.parts.assign(5000, "");
  file.content.materials.assign(1000, {});
  const Bytes whole = bytes_of(file);
  REQUIRE(!whole.empty());
  largest_allocation = 0;
  const Result<BlockFile> read = BlockFile::open(memory_source(whole));
  REQUIRE(read.ok());
  CHECK(largest_allocation <= 65'536);
  largest_allocation = 0;
  REQUIRE(read->read_page(0).ok());
  CHECK(largest_allocation <= 160 * kBlocksPerPage);
  largest_allocation = 0;
  REQUIRE(read->read_parts().ok());
  const std::size_t names = 2 * 5000 * sizeof(std::string);
  CHECK(largest_allocation <= std::max(names, kNamesTable));
  CHECK(largest_allocation >= 5000 * sizeof(std::string));  // the watch itself works
}

}  // namespace
}  // namespace crease
