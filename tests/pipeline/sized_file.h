// Files whose sizes are watched: tests/sizes.csv has them, bench/sizes writes it, and a test reads
// it.
//
//   const SizedModel model = simplify_sized(normals_alone(mesh), Placement::Optimal, true);
//   const std::vector<std::byte> bytes = encode_sized(model);
//
// Positions at 14 bits over the longest side; no attributes, or normals of 10 bits a component.
#pragma once

#include "codec/layer_coding.h"
#include "crease/contraction.h"
#include "crease/mesh.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace crease {

struct SizedModel {
  Mesh mesh;  // snapped
  std::vector<LayerCoding> codings;
  ContractionSequence sequence;
};

// What the simplifier makes of it; on all threads. Normals steer it also where they are not kept.
SizedModel simplify_sized(Mesh mesh, Placement placement, bool with_normals);

// All that a build does once the simplifier is done. Empty where that fails.
std::vector<std::byte> encode_sized(SizedModel model);

// Models that the tests make themselves, of every kind that there is: smooth, flat, creased, open,
// a city. `own_model` needs one of the names.
std::vector<std::string> own_models();
Mesh own_model(const std::string& name);

// A line of tests/sizes.csv.
struct SizeRow {
  std::string model;   // own:NAME, or NAME of bench/models*.txt
  std::string source;  // its path in the shared data, or -
  std::string import;  // --normals as it was imported with, or -
  std::size_t triangles = 0;
  Placement placement = Placement::Optimal;
  bool with_normals = false;
  std::size_t bytes = 0;

  bool is_same_file(const SizeRow& other) const {
    return model == other.model && placement == other.placement &&
           with_normals == other.with_normals;
  }
};
// Lines that are none are left out.
std::vector<SizeRow> read_sizes(const std::filesystem::path& path);
bool write_sizes(const std::filesystem::path& path, const std::vector<SizeRow>& rows);

}  // namespace crease
