// A model out of the blocks of a file: the finest mesh that they give, and the contractions that
// lead from it down to the base.
//
//   Result<ByteSourcePtr> source = open_file_source("city.crease");
//   Result<BlockFile> file = BlockFile::open(*source);
//   Result<DecodedModel> whole = decode_model(*file);
//   Result<DecodedModel> coarse = decode_model(*file, {.finest_band = 3});   // and reads no more
//
// From there on it is any mesh with a contraction sequence: build_progressive_arrays() makes levels
// of it, build_hierarchy() cuts. The images of its textures are read by BlockFile::read_images(),
// and belong into `images` of a level that is exported.
//
// What is exact: the mesh at the fine end of every block, corner for corner. Between the two ends
// of a block the file says which vertices were contracted, and where they stood; in which order,
// and what their attributes were meanwhile, follows from the geometry (docs/format-block.md,
// "Between the ends"), the same for every subset of blocks.
#pragma once

#include "crease/block_file.h"
#include "crease/contraction.h"
#include "crease/mesh.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace crease {

// Bits that blocks spend on what. Their sum is what the payloads take, but for whole bytes.
struct StreamBits {
  double roots = 0;       // the base mesh's vertices and triangles
  double flags = 0;       // which vertices are split
  double shapes = 0;      // which triangles a split introduces and moves
  double positions = 0;   //
  double categories = 0;  // materials, parts, derived triangles
  double values = 0;      // of attributes
  double labels = 0;      // patches of the next finer band

  StreamBits& operator+=(const StreamBits& other) {
    roots += other.roots;
    flags += other.flags;
    shapes += other.shapes;
    positions += other.positions;
    categories += other.categories;
    values += other.values;
    labels += other.labels;
    return *this;
  }
};

struct DecodeOptions {
  // Finer ones are left out. As many as there are bands: the base alone; more: nothing, an empty
  // mesh.
  std::uint16_t finest_band = 0;
  // How many of the finest bands that are decoded get their contractions. A level of such a model
  // is looked for in these; 0: the mesh alone, and no sequence.
  std::uint16_t contracted_bands = 0xffff;
  // Blocks that it wants are decoded, and all that those need, and the base always. Empty: wants
  // all.
  std::function<bool(const BlockEntry&)> wants{};
  // Calls body(i) for every i < count, in any order and on any threads. Empty: one after the other.
  std::function<void(std::size_t count, const std::function<void(std::size_t)>& body)> for_each{};
  // Of the decoded blocks together: about 150 a triangle of each band, which are 2.5 of the finest.
  std::uint64_t max_bytes = std::uint64_t(16) << 30;
  bool part_names = true;   // they lie at the file's end; false: the model has no parts
  bool count_bits = false;  // fills DecodedModel::bits; twice as slow
};

struct DecodedModel {
  Mesh mesh;         // snapped; holds check_mesh(). Has no parts while their names have not arrived
  LevelError error;  // of the mesh: not 0 where finer blocks were left out
  ContractionSequence sequence;     // of it, without bands; holds check_contractions()
  std::vector<BlockId> blocks;      // that were decoded, ascending
  std::vector<StreamBits> bits;     // if asked for: per band, finest first, the base last
  std::uint64_t payload_bytes = 0;  // of those blocks
};

// Fails naming the block or page that is wrong. Whatever the bytes are, it takes no more memory
// than a small multiple of max_bytes and of the blocks' payloads, and what decoding takes of one
// block on each thread. The result depends on the set of blocks alone.
// Threads: any, several on one file too.
Result<DecodedModel> decode_model(const BlockFile& file, const DecodeOptions& options = {});

}  // namespace crease
