#include "pipeline/encode_blocks.h"

#include "base/assert.h"

#include <algorithm>

namespace crease {

namespace {

// What a fine end is in terms of the input.
struct EndIds {
  std::uint32_t block = 0;
  std::vector<std::uint32_t> vertex_ids, triangle_ids;
};

std::vector<std::uint32_t> of_each(const std::vector<std::uint32_t>& ids,
                                   const std::vector<std::uint32_t>& indices) {
  std::vector<std::uint32_t> result;
  result.reserve(indices.size());
  for (const std::uint32_t i : indices) result.push_back(ids[i]);
  return result;
}

}  // namespace

std::vector<CodedBlock> encode_blocks(const std::vector<BandPlans>& plans,
                                      const codec::BlockCoding& coding) {
  std::vector<CodedBlock> blocks;
  std::vector<codec::FineEnd> ends;
  std::vector<EndIds> ids;
  std::vector<std::uint32_t> plan_of_vertex, plan_of_triangle;  // of the present patch, by input id
  for (std::uint32_t band = 0; band < plans.size(); ++band) {
    const BandPlans& of_band = plans[band];
    const std::uint32_t patches = static_cast<std::uint32_t>(of_band.plans.size());
    std::vector<codec::CoarseEnd> starts = codec::sort_by_label(ends, patches);
    std::vector<codec::FineEnd> next_ends;
    std::vector<EndIds> next_ids;
    for (std::uint32_t p = 0; p < patches; ++p) {
      const codec::BlockPlan& plan = of_band.plans[p];
      const auto number = [](std::vector<std::uint32_t>& index,
                             const std::vector<std::uint32_t>& of) {
        for (std::uint32_t i = 0; i < of.size(); ++i) {
          if (of[i] >= index.size()) index.resize(of[i] + 1);
          index[of[i]] = i;
        }
      };
      number(plan_of_vertex, of_band.vertex_ids[p]);
      number(plan_of_triangle, of_band.triangle_ids[p]);
      codec::CoarseEnd& start = starts[p];
      std::vector<std::uint32_t> triangles, vertices(start.mesh.positions.size());
      CodedBlock block;
      block.band = band;
      block.patch = p;
      block.limits = {static_cast<std::uint32_t>(plan.fine.positions.size()),
                      static_cast<std::uint32_t>(plan.fine.triangles.size())};
      for (std::uint32_t t = 0; t < start.sources.size(); ++t) {
        const auto [end, triangle] = start.sources[t];
        triangles.push_back(plan_of_triangle[ids[end].triangle_ids[triangle]]);
        for (std::size_t c = 0; c < 3; ++c) {
          vertices[start.mesh.triangles[t][c]] =
              plan_of_vertex[ids[end].vertex_ids[ends[end].mesh.triangles[triangle][c]]];
        }
        if (block.dependencies.empty() || block.dependencies.back() != ids[end].block) {
          block.dependencies.push_back(ids[end].block);
        }
      }
      const std::uint32_t id = static_cast<std::uint32_t>(blocks.size());
      codec::EncodedBlock encoded =
          codec::encode_block(plan, id, coding, std::move(start), triangles, vertices);
      block.bytes = std::move(encoded.bytes);
      next_ids.push_back({id, of_each(of_band.vertex_ids[p], encoded.plan_of_vertex),
                          of_each(of_band.triangle_ids[p], encoded.plan_of_triangle)});
      next_ends.push_back(std::move(encoded.decoded.end));
      blocks.push_back(std::move(block));
    }
    ends = std::move(next_ends);
    ids = std::move(next_ids);
  }
  return blocks;
}

}  // namespace crease
