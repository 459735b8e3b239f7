// What every maker of a contraction sequence promises, tested by following it.
#include "crease/contraction.h"

#include "hierarchy/attribute_values.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

namespace crease {

namespace {

Failure broken(std::size_t contraction, const std::string& what) {
  return fail(Error::Invalid, "contraction " + std::to_string(contraction) + ": " + what);
}

std::array<float, 4> as_array(const LevelError& e) {
  return {e.surface, e.line, e.degrees, e.texture};
}

bool is_error(const LevelError& e) {
  const std::array<float, 4> parts = as_array(e);
  return std::all_of(parts.begin(), parts.end(),
                     [](float f) { return std::isfinite(f) && f >= 0; });
}

bool at_least(const LevelError& a, const LevelError& b) {
  return a.surface >= b.surface && a.line >= b.line && a.degrees >= b.degrees &&
         a.texture >= b.texture;
}

class Checker {
 public:
  Checker(const Mesh& snapped, const ContractionSequence& sequence)
      : mesh_(snapped), sequence_(sequence) {}

  Status run() {
    if (auto failure = check_values()) return *failure;
    prepare();
    for (std::size_t i = 0; i < sequence_.contractions.size(); ++i) {
      if (auto failure = check_record(i)) return *failure;
      const Contraction& c = sequence_.contractions[i];
      apply_geometry(c);
      if (auto failure = check_derived(i)) return *failure;
      if (auto failure = check_changes(i)) return *failure;
    }
    return Done{};
  }

 private:
  std::optional<Failure> check_values() const {
    if (sequence_.new_values.size() > mesh_.layers.size()) {
      return fail(Error::Invalid, "new values for more layers than there are");
    }
    for (std::size_t l = 0; l < sequence_.new_values.size(); ++l) {
      const std::vector<float>& values = sequence_.new_values[l];
      if (values.size() % mesh_.layers[l].dimension != 0) {
        return fail(Error::Invalid, "layer " + std::to_string(l) + ": odd number of new values");
      }
      if (!std::all_of(values.begin(), values.end(), [](float f) { return std::isfinite(f); })) {
        return fail(Error::Invalid, "layer " + std::to_string(l) + ": a new value is not finite");
      }
    }
    return std::nullopt;
  }

  void prepare() {
    const std::size_t triangle_count = mesh_.triangle_count();
    vertices_ = mesh_.triangles;
    alive_.assign(triangle_count, true);
    derived_.assign(triangle_count, false);
    for (const AttributeLayer& layer : mesh_.layers) of_corner_.push_back(layer.of_corner);
    around_.resize(mesh_.vertex_count());
    for (std::uint32_t t = 0; t < triangle_count; ++t) {
      for (VertexId v : vertices_[t]) around_[index_of(v)].push_back(t);
    }
    for (const Vec3d& p : mesh_.positions) positions_.push_back(sequence_.grid.nearest(p));
    removed_.assign(mesh_.vertex_count(), false);
    errors_.resize(mesh_.vertex_count());
  }

  std::optional<Failure> check_record(std::size_t i) {
    const Contraction& c = sequence_.contractions[i];
    const std::size_t p = index_of(c.removed), q = index_of(c.kept);
    if (p >= mesh_.vertex_count() || q >= mesh_.vertex_count()) {
      return broken(i, "vertex out of range");
    }
    if (p == q) return broken(i, "a vertex with itself");
    if (removed_[p] || removed_[q]) return broken(i, "its vertex was removed before");
    if (sequence_.placement == Placement::Endpoint && c.position != positions_[p] &&
        c.position != positions_[q]) {
      return broken(i, "not at an endpoint");
    }
    if (!is_error(c.error)) return broken(i, "its error is not a number of zero or more");
    if (!at_least(c.error, errors_[p]) || !at_least(c.error, errors_[q])) {
      return broken(i, "its error is less than that of a contraction under it");
    }
    const auto inside = [](std::uint32_t first, std::uint32_t count, std::size_t size) {
      return std::uint64_t(first) + count <= size;
    };
    if (!inside(c.first_change, c.change_count, sequence_.changes.size())) {
      return broken(i, "attribute changes out of range");
    }
    if (!inside(c.first_derived, c.derived_count, sequence_.derived.size())) {
      return broken(i, "derived triangles out of range");
    }
    return std::nullopt;
  }

  void apply_geometry(const Contraction& c) {
    std::vector<std::uint32_t>& around_p = around_[index_of(c.removed)];
    std::vector<std::uint32_t>& around_q = around_[index_of(c.kept)];
    for (std::uint32_t t : around_p) {
      if (!alive_[t]) continue;
      if (std::count(vertices_[t].begin(), vertices_[t].end(), c.kept) > 0) {
        alive_[t] = false;
        continue;
      }
      std::replace(vertices_[t].begin(), vertices_[t].end(), c.removed, c.kept);
      around_q.push_back(t);
    }
    around_p = {};
    std::erase_if(around_q, [this](std::uint32_t t) { return !alive_[t]; });
    removed_[index_of(c.removed)] = true;
    positions_[index_of(c.kept)] = c.position;
    errors_[index_of(c.kept)] = c.error;
  }

  std::optional<Failure> check_derived(std::size_t i) {
    for (TriangleId id : sequence_.derived_of(sequence_.contractions[i])) {
      const std::size_t t = index_of(id);
      if (t >= mesh_.triangle_count()) return broken(i, "derived triangle out of range");
      if (!alive_[t]) return broken(i, "derived triangle " + std::to_string(t) + " has vanished");
      if (derived_[t]) return broken(i, "triangle " + std::to_string(t) + " derived twice");
      if (mesh_.normals() == nullptr)
        return broken(i, "derived triangle in a mesh without normals");
      derived_[t] = true;
    }
    return std::nullopt;
  }

  std::optional<Failure> check_changes(std::size_t i) {
    const Contraction& c = sequence_.contractions[i];
    const std::span<const AttributeChange> changes = sequence_.changes_of(c);
    from_.clear();
    for (const AttributeChange& change : changes) from_.emplace_back(change.layer, change.from);
    std::sort(from_.begin(), from_.end());
    for (const AttributeChange& change : changes) {
      if (change.layer >= mesh_.layers.size()) return broken(i, "attribute layer out of range");
      const AttributeLayer& layer = mesh_.layers[change.layer];
      const std::size_t value_count =
          layer.value_count() + new_value_count(layer, sequence_, change.layer);
      if (index_of(change.from) >= value_count || index_of(change.to) >= value_count) {
        return broken(i, "attribute out of range in layer '" + layer.name + "'");
      }
      if (change.from == change.to) return broken(i, "attribute becomes itself");
      const auto [first, last] =
          std::equal_range(from_.begin(), from_.end(), std::pair(change.layer, change.from));
      if (last - first != 1) return broken(i, "attribute changes twice");
      if (std::binary_search(from_.begin(), from_.end(), std::pair(change.layer, change.to))) {
        return broken(i, "attribute changes depend on their order");
      }
      if (!change_attribute(c.kept, change, layer.role == AttributeRole::Normal)) {
        return broken(i, "attribute " + std::to_string(index_of(change.from)) + " of layer '" +
                             layer.name + "' does not stand at the vertex");
      }
    }
    return std::nullopt;
  }

  // Whether `from` stood at q. A maker of sequences may go on changing the stored normals of
  // derived triangles, which nobody sees; so these are followed here, unlike in
  // apply_contractions().
  bool change_attribute(VertexId q, const AttributeChange& change, bool is_normal) {
    bool stands = false;
    for (std::uint32_t t : around_[index_of(q)]) {
      for (std::size_t c = 0; c < 3; ++c) {
        AttributeId& attribute = of_corner_[change.layer][3 * t + c];
        if (vertices_[t][c] != q || attribute != change.from) continue;
        attribute = change.to;
        stands = true;
      }
      stands = stands || (is_normal && derived_[t]);
    }
    return stands;
  }

  const Mesh& mesh_;
  const ContractionSequence& sequence_;
  std::vector<Triangle> vertices_;
  std::vector<bool> alive_, derived_, removed_;
  std::vector<std::vector<AttributeId>> of_corner_;
  std::vector<std::vector<std::uint32_t>> around_;
  std::vector<Vec3i> positions_;
  std::vector<LevelError> errors_;
  std::vector<std::pair<std::uint32_t, AttributeId>> from_;  // of one contraction's changes, sorted
};

}  // namespace

Status check_contractions(const Mesh& snapped, const ContractionSequence& sequence) {
  return Checker(snapped, sequence).run();
}

}  // namespace crease
