// Crease lines of blocks against those of the mesh that the cut shows.
#include "render/block_creases.h"

#include "crease/draw_list.h"
#include "support/mesh_zoo.h"
#include "view/streamed_model.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace crease {

namespace {

using Ends = std::tuple<float, float, float, float, float, float>;

// By the places of their ends, in units of a thousandth.
std::vector<Ends> places(std::span<const Line3f> lines, const Vec3d& origin) {
  std::vector<Ends> all;
  const auto place = [&](const Vec3f& p, int i) {
    return float(std::lround(1e3 * (double(p[i]) + origin[i])));
  };
  for (const Line3f& line : lines) {
    Ends a{place(line.from, 0), place(line.from, 1), place(line.from, 2),
           place(line.to, 0),   place(line.to, 1),   place(line.to, 2)};
    Ends b{std::get<3>(a), std::get<4>(a), std::get<5>(a),
           std::get<0>(a), std::get<1>(a), std::get<2>(a)};
    all.push_back(std::min(a, b));
  }
  std::sort(all.begin(), all.end());
  return all;
}

CreaseLines lines_of_cut(const BlockMesh& mesh) {
  std::vector<BlockCreases> blocks;
  for (const ShownRange& run : mesh.shown()) blocks.push_back(creases_of(*run.block));
  std::vector<std::span<const RimEdge>> rims;
  std::vector<Line3f> inner;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const Range hard = hard_of_run(mesh.shown()[i], blocks[i], rims);
    const auto first = blocks[i].hard.begin() + hard.first;
    inner.insert(inner.end(), first, first + hard.count);
  }
  CreaseLines lines = join_rims(rims);
  lines.hard.insert(lines.hard.end(), inner.begin(), inner.end());
  return lines;
}

}  // namespace

TEST_CASE("the lines of blocks are those of the mesh that they show together") {
  Mesh open = smooth_sphere(40, 80);
  open.triangles.resize(open.triangles.size() / 2);
  for (AttributeLayer& layer : open.layers) layer.of_corner.resize(3 * open.triangles.size());
  int cuts_between_bands = 0;
  for (const Mesh& mesh : {hard_box(24), city_blocks(4, 6), smooth_sphere(40, 80), open}) {
    const StreamedModel model = streamed_model(mesh, 300);
    BlockStreamer streamer = model.stream();
    for (const double pixels : {8.0, 1.0, 0.1}) {
      BlockViewParameters parameters;
      parameters.in_levels = false;
      const Vec3d middle = (model.low + model.high) * 0.5, size = model.high - model.low;
      parameters.view.camera.target = middle;
      parameters.view.camera.position = middle + Vec3d{0.3, -0.5, 0.8} * length(size);
      parameters.view.camera.width_px = parameters.view.camera.height_px = 300;
      parameters.view.camera.pixels = pixels;
      finish(streamer, parameters);
      const BlockMesh& blocks = streamer.mesh();
      const auto band = [](const ShownRange& run) { return run.block->facts().band; };
      cuts_between_bands += band(blocks.shown().front()) != band(blocks.shown().back());
      const CreaseLines found = lines_of_cut(blocks);
      const Mesh shown = blocks.extract();
      const MeshDrawArrays arrays(shown);
      const CreaseLines expected = crease_lines(arrays.draw_list());
      const Vec3d origin = blocks.facts().grid.origin, other = arrays.draw_list().origin;
      CHECK(places(found.hard, origin) == places(expected.hard, other));
      CHECK(places(found.borders, origin) == places(expected.borders, other));
    }
  }
  CHECK(cuts_between_bands > 0);
}

}  // namespace crease
