// The three-part arrays of a block (DB03, section 3), each part group by group.
#include "codec/layer_values.h"
#include "crease/shading.h"
#include "hierarchy/geometric_normal.h"
#include "runtime/draw_values.h"
#include "runtime/group_by_place.h"
#include "runtime/resident_block.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>

namespace crease {

namespace {

class BlockLayout {
 public:
  BlockLayout(const codec::FineEnd& end, ResidentBlock::Data& block)
      : block_(block), schema_(*block.schema), end_(end), mesh_(end.mesh) {
    for (std::size_t l = 0; l < schema_.facts.layers.size(); ++l) {
      const LayerSchema& layer = schema_.facts.layers[l];
      const bool is_normal = layer.role == AttributeRole::Normal && layer.dimension == 3;
      if (is_normal && !normals_) normals_.emplace(Layer{l, values_of(l)});
      if (layer.role == AttributeRole::Color && !colors_) colors_.emplace(Layer{l, values_of(l)});
    }
    const std::uint32_t painted = drawn_texcoords(schema_.facts.layers);
    if (painted != kNone) texcoords_.emplace(Layer{painted, values_of(painted)});
  }

  void run() {
    sort_vertices();
    std::vector<std::uint32_t> order(mesh_.triangles.size());
    std::iota(order.begin(), order.end(), 0);
    const auto label = [&](std::uint32_t t) { return end_.labels[t]; };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return label(a) < label(b); });
    reserve();
    std::vector<std::size_t> ends;
    for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
      while (end < order.size() && label(order[end]) == label(order[begin])) ++end;
      group_by_place(
          order, begin, end, [this](std::uint32_t t) { return place(t); }, ends);
    }
    for (std::size_t begin = 0, i = 0; i < ends.size(); begin = ends[i++]) {
      BlockGroup group{.patch = label(order[begin]),
                       .sn = next(block_.sn),
                       .fn = next(block_.fn),
                       .nsn = next(block_.nsn),
                       .low = first_position(order[begin]),
                       .high = first_position(order[begin])};
      for (std::size_t t = begin; t < ends[i]; ++t) add(order[t], group);
      block_.groups.push_back(group);
    }
    block_.groups.shrink_to_fit();
  }

 private:
  std::array<std::int64_t, 3> place(std::uint32_t t) const {
    std::array<std::int64_t, 3> sum{};
    for (const std::uint32_t v : mesh_.triangles[t]) {
      const Vec3i& p = mesh_.positions[v];
      sum = {sum[0] + p.x, sum[1] + p.y, sum[2] + p.z};
    }
    return sum;
  }

  struct Layer {
    std::size_t index;
    LayerValues values;
  };

  LayerValues values_of(std::size_t l) const {
    return LayerValues(schema_.codings[l], schema_.facts.layers[l].dimension);
  }

  bool is_flat(std::uint32_t t) const { return !normals_ || mesh_.derived[t]; }
  const codec::CodedValue* codes(const Layer& layer, std::uint32_t t) const {
    return &mesh_.values[layer.index][3 * std::size_t(t)];
  }
  Vec3f normal(const codec::CodedValue& code) const {
    std::array<float, 3> n{};
    normals_->values.read(code, n);
    return {n[0], n[1], n[2]};
  }

  static Range next(const BlockPart& part) {
    return {static_cast<std::uint32_t>(part.indices.size() / 3), 0};
  }

  // SN vertices first: those at which all corners of the block have one normal.
  void sort_vertices() {
    const std::size_t count = mesh_.positions.size();
    is_shared_.assign(count, normals_ ? 1 : 0);
    std::vector<const codec::CodedValue*> first(count, nullptr);
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t v = mesh_.triangles[t][c];
        if (is_flat(t)) {
          is_shared_[v] = 0;
          continue;
        }
        const codec::CodedValue* code = codes(*normals_, t) + c;
        if (first[v] == nullptr) first[v] = code;
        if (*first[v] != *code) is_shared_[v] = 0;
      }
    }
    std::vector<std::uint32_t>& place = position_of_vertex_;
    place.resize(count);
    block_.positions.reserve(count);
    block_.vertex_normals.reserve(
        static_cast<std::size_t>(std::count(is_shared_.begin(), is_shared_.end(), 1)));
    for (const bool shared : {true, false}) {
      for (std::uint32_t v = 0; v < count; ++v) {
        if ((is_shared_[v] != 0) != shared) continue;
        place[v] = static_cast<std::uint32_t>(block_.positions.size());
        block_.positions.push_back(draw_position(schema_.facts.grid, mesh_.positions[v]));
        if (shared) block_.vertex_normals.push_back(first[v] ? normal(*first[v]) : Vec3f{});
      }
    }
    block_.position_of_vertex = PackedIndices<>(bits_for(count));
    block_.position_of_vertex.reserve(count);
    for (const std::uint32_t p : place) block_.position_of_vertex.push_back(p);
  }

  TriangleKind kind(std::uint32_t t) const {
    if (is_flat(t)) return TriangleKind::FN;
    const codec::Corners& v = mesh_.triangles[t];
    if (is_shared_[v[0]] && is_shared_[v[1]] && is_shared_[v[2]]) return TriangleKind::SN;
    const codec::CodedValue* code = codes(*normals_, t);
    return code[0] == code[1] && code[1] == code[2] ? TriangleKind::FN : TriangleKind::NSN;
  }

  void reserve() {
    std::array<std::size_t, 3> count{};
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) ++count[std::size_t(kind(t))];
    const std::array<std::size_t, 3> normals{0, 1, 3};
    for (const TriangleKind k : {TriangleKind::SN, TriangleKind::FN, TriangleKind::NSN}) {
      const std::size_t n = count[std::size_t(k)];
      BlockPart& to = part(k);
      to.indices.reserve(3 * n);
      to.normals.reserve(normals[std::size_t(k)] * n);
      if (!schema_.materials.empty()) to.materials.reserve(n);
      if (schema_.coding.part_count > 1) {
        to.parts = PackedIndices<>(bits_for(schema_.coding.part_count));
        to.parts.reserve(n);
      }
      if (colors_) to.colors.reserve(3 * n);
      if (texcoords_) to.texcoords.reserve(3 * n);
    }
  }

  BlockPart& part(TriangleKind k) {
    return k == TriangleKind::SN ? block_.sn : k == TriangleKind::FN ? block_.fn : block_.nsn;
  }

  void add(std::uint32_t t, BlockGroup& group) {
    const TriangleKind k = kind(t);
    BlockPart& to = part(k);
    ++(k == TriangleKind::SN ? group.sn : k == TriangleKind::FN ? group.fn : group.nsn).count;
    for (const std::uint32_t v : mesh_.triangles[t]) {
      to.indices.push_back(position_of_vertex_[v]);
      const Vec3f& p = block_.positions[to.indices.back()];
      group.low = {std::min(group.low.x, p.x), std::min(group.low.y, p.y),
                   std::min(group.low.z, p.z)};
      group.high = {std::max(group.high.x, p.x), std::max(group.high.y, p.y),
                    std::max(group.high.z, p.z)};
    }
    if (k == TriangleKind::FN) to.normals.push_back(flat_normal(t));
    if (k == TriangleKind::NSN) {
      for (std::size_t c = 0; c < 3; ++c) to.normals.push_back(normal(codes(*normals_, t)[c]));
    }
    if (!schema_.materials.empty()) {
      to.materials.push_back(mesh_.category[t] % schema_.coding.material_count);
    }
    if (schema_.coding.part_count > 1) {
      to.parts.push_back(mesh_.category[t] / schema_.coding.material_count);
    }
    for (std::size_t c = 0; texcoords_ && c < 3; ++c) {
      std::array<float, 2> uv{};
      texcoords_->values.read(codes(*texcoords_, t)[c], uv);
      to.texcoords.push_back(uv);
    }
    if (!colors_) return;
    std::array<float, 4> value{};
    const std::span<float> numbers =
        std::span(value).first(schema_.facts.layers[colors_->index].dimension);
    for (std::size_t c = 0; c < 3; ++c) {
      colors_->values.read(codes(*colors_, t)[c], numbers);
      to.colors.push_back(draw_color(numbers));
    }
  }

  const Vec3f& first_position(std::uint32_t t) const {
    return block_.positions[position_of_vertex_[mesh_.triangles[t][0]]];
  }

  Vec3f flat_normal(std::uint32_t t) const {
    if (!is_flat(t)) return normal(codes(*normals_, t)[0]);
    const codec::Corners& v = mesh_.triangles[t];
    const Vec3f n =
        geometric_normal(mesh_.positions[v[0]], mesh_.positions[v[1]], mesh_.positions[v[2]]);
    return n == Vec3f{} ? Vec3f{0, 0, 1} : n;  // without area: any
  }

  ResidentBlock::Data& block_;
  const codec::ModelSchema& schema_;
  const codec::FineEnd& end_;
  const codec::PatchMesh& mesh_;
  std::optional<Layer> normals_, colors_, texcoords_;
  std::vector<char> is_shared_;                    // per vertex: SN
  std::vector<std::uint32_t> position_of_vertex_;  // as the block's
};

}  // namespace

void lay_out_for_drawing(const codec::FineEnd& end, ResidentBlock::Data& block) {
  BlockLayout(end, block).run();
}

}  // namespace crease
