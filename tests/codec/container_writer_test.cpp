#include "base/bytes.h"
#include "codec/atomic_file.h"
#include "codec/container.h"
#include "codec/container_files.h"
#include "codec/decode_container.h"
#include "codec/encode_page.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <limits>

#include <unistd.h>

namespace crease {
namespace {

struct OwnFolder {
  std::filesystem::path path = std::filesystem::temp_directory_path() /
                               ("crease-container-test-" + std::to_string(::getpid()));
  OwnFolder() { std::filesystem::create_directories(path); }
  ~OwnFolder() { std::filesystem::remove_all(path); }
};

TEST_CASE("a file of blocks on the disk has the bytes of one in memory") {
  const OwnFolder folder;
  const std::filesystem::path path = folder.path / "a.crease";
  const WrittenFile file = random_file(2, 700, 200);
  Result<AtomicFile> out = AtomicFile::create(path);
  REQUIRE(out.ok());
  REQUIRE(write_container(file, *out).ok());
  CHECK(!std::filesystem::exists(path));  // not before commit
  REQUIRE(out->commit().ok());

  const Result<ByteSourcePtr> source = open_file_source(path);
  REQUIRE(source.ok());
  const Result<BlockFile> read = BlockFile::open(*source);
  REQUIRE(read.ok());
  CHECK(read->source().bytes_read() <= 65'536);
  CHECK((bytes_of(read_whole(*read)) == bytes_of(file)));
  std::vector<std::byte> bytes(static_cast<std::size_t>((*source)->size()));
  REQUIRE((*source)->read(0, bytes).ok());
  CHECK((bytes == bytes_of(file)));
}

TEST_CASE("a file that is not committed leaves nothing behind") {
  const OwnFolder folder;
  {
    Result<AtomicFile> out = AtomicFile::create(folder.path / "a.crease");
    REQUIRE(out.ok());
    REQUIRE(write_container(random_file(2, 3, 20), *out).ok());
    CHECK(!std::filesystem::is_empty(folder.path));
  }
  CHECK(std::filesystem::is_empty(folder.path));
}

TEST_CASE("a source that is missing or a folder says so") {
  const OwnFolder folder;
  CHECK(open_file_source(folder.path / "no.crease").failure().error == Error::NotFound);
  CHECK(open_file_source(folder.path).failure().error == Error::ReadFailed);
}

TEST_CASE("a source gives what it has, and counts it") {
  const std::vector<std::byte> bytes(10);
  const ByteSourcePtr source = memory_source(bytes);
  std::vector<std::byte> into(4);
  CHECK(source->read(6, into).ok());
  CHECK(source->read(7, into).failure().error == Error::Truncated);
  CHECK(source->read(~std::uint64_t(0), into).failure().error == Error::Truncated);
  CHECK(source->bytes_read() == 4);
  CHECK(source->read_count() == 1);
}

// A disk that is full after some writes.
struct FullSink final : ByteSink {
  int writes_left;
  explicit FullSink(int writes) : writes_left(writes) {}
  Status write(std::uint64_t, std::span<const std::byte>) override {
    if (writes_left-- > 0) return Done{};
    return fail(Error::WriteFailed, "full");
  }
};

TEST_CASE("every failed write is told") {
  const WrittenFile file = random_file(2, 600, 20);
  // Three sections, two pages and the blocks behind each, the head.
  const int needed = 3 + 2 * 2 + 1;
  for (int writes = 0; writes < needed; ++writes) {
    CAPTURE(writes);
    FullSink sink(writes);
    CHECK(!write_container(file, sink).ok());
  }
  FullSink enough(needed);
  CHECK(write_container(file, enough).ok());
  CHECK(enough.writes_left == 0);
}

// Both as the writer sees it.
std::string refusal(const WrittenFile& file) {
  MemorySink sink;
  const Status status = write_container(file, sink);
  return status.ok() ? "" : status.failure().message;
}

TEST_CASE("a writer refuses what a reader would") {
  const WrittenFile good = random_file(2, 3, 20);
  CHECK(refusal(good).empty());
  const auto with = [&good](auto change) {
    WrittenFile file = good;
    change(file);
    return refusal(file);
  };
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kMax = std::numeric_limits<float>::max();
  CHECK(with([](WrittenFile& f) { f.blocks[1].facts.fine.line = kNan; }) ==
        "block 1: an error is no finite number from 0 on");
  CHECK(with([](WrittenFile& f) { f.blocks[1].facts.coarse.line = -1; }) ==
        "block 1: an error is no finite number from 0 on");
  CHECK(with([](WrittenFile& f) { f.blocks[1].facts.coarse.line = kMax; }) ==
        "block 1: an error is no finite number from 0 on");
  CHECK(with([](WrittenFile& f) { f.blocks[0].facts.fine.line = 1e30f; }) ==
        "block 0: its fine end has the greater error");
  CHECK(with([](WrittenFile& f) { f.blocks[0].facts.band = 3; }) ==
        "block 0: there is no such band");
  CHECK(with([](WrittenFile& f) { f.blocks[2].dependencies = {BlockId{2}}; }) ==
        "block 2: it needs a block that is not before it");
  CHECK(with([](WrittenFile& f) {
          f.blocks[2].dependencies = {BlockId{1}, BlockId{0}};
        }) == "block 2: what it needs does not ascend");
  CHECK(with([](WrittenFile& f) { f.content.facts.grid.step = 0; }).starts_with("grid"));
  CHECK(with([](WrittenFile& f) { f.content.facts.layers[1].role = AttributeRole::Normal; }) ==
        "layer 1: a second layer of normals");
  CHECK(with([](WrittenFile& f) { f.content.facts.layers[0].dimension = 4; }) ==
        "layer 0: normals are not of dimension 3");
  CHECK(with([](WrittenFile& f) { f.content.facts.layers[1].dimension = 2; }) ==
        "layer 1: a coding of directions for what is none");
  CHECK(with([](WrittenFile& f) { f.content.facts.layers[3].bits = 8; }) ==
        "layer 3: bits out of range");
  CHECK(with([](WrittenFile& f) { f.content.materials[0].base_color[2] = kNan; }) ==
        "materials: a colour is not finite");
  for (const float cutoff : {float(kNan), -1.0f}) {
    CHECK(with([&](WrittenFile& f) { f.content.materials[0].alpha_cutoff = cutoff; }) ==
          "materials: a cutoff of alpha is no number from 0 on");
  }
  CHECK(with([](WrittenFile& f) {
          f.content.facts.layers[0].name.resize(70'000);
        }).starts_with("layers, bands and pages take "));
}

TEST_CASE("a writer holds its caller to what was announced") {
  MemorySink sink;
  const BlockFacts facts;
  const BlockId first[] = {BlockId{0}};
  Result<ContainerWriter> writer = ContainerWriter::begin(sink, some_content(), 2);
  REQUIRE(writer.ok());
  CHECK(writer->finish().failure().message == "0 of 2 blocks were written");
  REQUIRE(writer->add(facts, {}, {}).ok());
  REQUIRE(writer->add(facts, first, {}).ok());
  CHECK(writer->add(facts, {}, {}).failure().message == "block 2: more blocks than announced");
  REQUIRE(writer->finish().ok());
  CHECK(BlockFile::open(memory_source(sink.bytes())).ok());
}

TEST_CASE("more blocks or dependencies than a head or a page has room for are refused") {
  MemorySink sink;
  CHECK(ContainerWriter::begin(sink, some_content(), 3'000'000).failure().error ==
        Error::OverLimit);
  Result<ContainerWriter> writer = ContainerWriter::begin(sink, some_content(), 2'600'000);
  REQUIRE(writer.ok());
  std::vector<BlockId> all;
  const auto add = [&](std::span<const BlockId> needed) {
    all.push_back(BlockId{static_cast<std::uint32_t>(all.size())});
    return writer->add({}, needed, {});
  };
  while (all.size() < 5 * kBlocksPerPage) REQUIRE(add({}).ok());
  Status status = Done{};
  while (status.ok()) status = add(std::vector(all));
  CHECK(all.size() < 6 * kBlocksPerPage);
  CHECK(status.failure().message ==
        "block " + std::to_string(all.size() - 1) + ": too many dependencies for its page");
}

TEST_CASE("a sphere that is rounded up has all of what it was within it") {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 100'000; ++trial) {
    BlockFacts facts;
    const auto any = [&random](int bits) {
      return static_cast<std::uint32_t>(random() % (std::uint64_t(1) << bits)) >> random() % bits;
    };
    facts.radius = any(32);
    for (int k = 0; k < 3; ++k) facts.center[k] = static_cast<std::int32_t>(any(32));
    const std::optional<BlockFacts> rounded = rounded_up(facts);
    if (!rounded) {
      REQUIRE(facts.radius > 0xfc000000);
      continue;
    }
    double squared = 0;
    for (int k = 0; k < 3; ++k) {
      const double aside = double(rounded->center[k]) - double(facts.center[k]);
      squared += aside * aside;
    }
    CAPTURE(facts.radius);
    REQUIRE(std::sqrt(squared) + facts.radius <= rounded->radius);
    REQUIRE(rounded->radius <= 1.02 * facts.radius);
    REQUIRE(same_facts(*rounded_up(*rounded), *rounded));
  }
}

TEST_CASE("what a material says beyond its colour is looked at when it is read") {
  const auto read = [](float cutoff, std::uint8_t flags,
                       std::uint16_t layout = format::kLayoutWithSurfaces) {
    ByteWriter out;
    out.u32(1);
    out.text("leaf");
    out.f32s(std::array<float, 4>{1, 1, 1, 1});
    out.text("");
    out.f32(cutoff);
    out.u8(flags);
    return decode_materials(out.take(), layout);
  };
  REQUIRE(read(0.5f, 1).ok());
  CHECK(read(0.5f, 1)->front().alpha_cutoff == 0.5f);
  CHECK(read(0.5f, 1)->front().double_sided);
  CHECK_FALSE(read(0.5f, 0)->front().double_sided);
  CHECK(read(0.5f, 2).failure().message == "materials: a reserved flag");
  CHECK(read(0, 2, format::kLayoutWithBlending)->front().is_blended);
  CHECK(read(0, 3, format::kLayoutWithBlending)->front().double_sided);
  CHECK_FALSE(read(0, 1, format::kLayoutWithBlending)->front().is_blended);
  CHECK(read(0, 4, format::kLayoutWithBlending).failure().message == "materials: a reserved flag");
  CHECK(read(-0.5f, 0).failure().message == "materials: a cutoff of alpha is no number from 0 on");
}

TEST_CASE("whatever of images, holes, sides and blending there is, the file is read") {
  for (unsigned has = 0; has < 16; ++has) {
    CAPTURE(has);
    WrittenFile written = random_file(1, 6, 24);
    if (has & 1u) written.content.images = some_images();
    std::vector<Material>& materials = written.content.materials;
    if (has & 2u) materials[0].alpha_cutoff = 0.25f;
    if (has & 4u) materials[1].double_sided = true;
    if (has & 8u) materials[1].is_blended = true;
    const std::vector<std::byte> bytes = bytes_of(written);
    const int version = has & 8u ? 13 : has & 6u ? 12 : has & 1u ? 11 : 10;
    CHECK(bytes[8] == std::byte(version));
    const Result<BlockFile> file = BlockFile::open(memory_source(bytes));
    REQUIRE_MESSAGE(file.ok(), (file.ok() ? "" : file.failure().message));
    CHECK(file->validate().empty());
    CHECK(*file->read_materials() == materials);
    CHECK(file->read_images()->size() == written.content.images.size());
  }
}

TEST_CASE("older layouts and newer versions are told apart") {
  std::vector<std::byte> bytes = bytes_of(random_file(2, 3, 20));
  CHECK(BlockFile::open(memory_source(bytes)).ok());
  for (const int older : {1, 2, 3, 4, 5}) {
    bytes[8] = std::byte(older);
    const Failure refused = BlockFile::open(memory_source(bytes)).failure();
    CHECK(refused.error == Error::NotSupported);
    CHECK(refused.message.ends_with("build the file again"));
  }
  bytes[8] = std::byte(format::kNewestVersion + 1);
  CHECK(BlockFile::open(memory_source(bytes)).failure().error == Error::VersionTooNew);
}

}  // namespace
}  // namespace crease
