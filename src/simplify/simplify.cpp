// The bands: partition, simplify every patch up to the band's limit, put the patches' contractions
// in one order, and go on with the mesh that is left.
#include "crease/simplify.h"

#include "base/assert.h"
#include "parallel/parallel.h"
#include "parallel/shared_progress.h"
#include "simplify/far_area.h"
#include "simplify/fit_normals.h"
#include "simplify/partition.h"
#include "simplify/pass_limits.h"
#include "simplify/patch_simplifier.h"
#include "simplify/scales.h"
#include "simplify/work_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <mutex>
#include <numeric>
#include <optional>

namespace crease {

namespace simplification {
namespace {

// Below this share of the input's triangles, or this many, places are chosen for their cost rather
// than for the bits that a file takes: these vertices are few.
constexpr double kCoarseShare = 0.1, kCoarseLeavesPair = 0.9;
constexpr std::size_t kCoarse = 2000;

// Above this share, and this many, a vertex that stays where it was is not moved for the volume
// either: most vertices are here, and what is cut off is little.
constexpr double kFineShare = 0.4;
constexpr std::size_t kFine = 10'000;

// The first pass contracts pairs that cost no more than this share of all do: with more of them its
// borders show in levels of half the triangles, with fewer the first band is hardly worth a file's
// while.
constexpr double kFirstPairs = 0.45;

// Below this many triangles one last band goes all the way.
constexpr std::size_t kLastBand = 64;

// After so many bands in which hardly anything happened the reason is not their limit: one patch
// does all that is left, and several become fewer, since all their vertices may lie on borders.
constexpr int kMostStalls = 3;

// More than any contraction costs, and less than what is never done (infinity).
constexpr double kNoLimit = 1e300;

// To join two parts (virtual pairs) takes no triangle away but moves both: while they have
// triangles to give, it only tears them. A part of fewer than kCard has none to give, a tile of a
// roof or a leaf, and may join at any time: else half a roof of tiles would be single triangles.
// One of fewer than this may where that is what parts have on average. Either joins its like, or
// what is larger: a leaf on a thin branch would be dragged along by what the branch gives.
constexpr std::uint32_t kFewTriangles = 6;

// Positions are rounded to the grid: this much surface error is not error, grid units.
constexpr double kGridNoise = 0.6;

// Union-find over the vertices: `parent` leads to the part's smallest vertex.
std::uint32_t part_of(std::vector<std::uint32_t>& parent, std::uint32_t v) {
  while (parent[v] != v) v = parent[v] = parent[parent[v]];
  return v;
}

void join_parts(WorkMesh& work, std::uint32_t u, std::uint32_t v) {
  u = part_of(work.part_of_vertex, u);
  v = part_of(work.part_of_vertex, v);
  if (u == v) return;
  work.part_of_vertex[std::max(u, v)] = std::min(u, v);
  --work.part_count;
}

void find_parts(WorkMesh& work) {
  work.part_of_vertex.resize(work.positions.size());
  std::iota(work.part_of_vertex.begin(), work.part_of_vertex.end(), 0u);
  std::vector<char> used(work.positions.size(), 0);
  for (std::uint32_t v : work.vertex_of_corner) used[v] = 1;
  work.part_count = static_cast<std::size_t>(std::count(used.begin(), used.end(), 1));
  for (std::size_t corner = 0; corner < work.vertex_of_corner.size(); corner += 3) {
    join_parts(work, work.vertex_of_corner[corner], work.vertex_of_corner[corner + 1]);
    join_parts(work, work.vertex_of_corner[corner], work.vertex_of_corner[corner + 2]);
  }
  // Parents are smaller: each vertex leads to its part at once. Chains can be as long as the mesh.
  for (std::uint32_t& part : work.part_of_vertex) part = work.part_of_vertex[part];
}

// The live triangles of each part and their area, and how many parts have any. From then on
// `part_of_vertex` leads to the parts of live vertices at once.
std::size_t measure_parts(WorkMesh& work) {
  std::vector<std::uint32_t>& part = work.part_of_vertex;
  if (3 * work.live.size() < work.positions.size()) {
    for (std::uint32_t t : work.live) {
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t v = work.vertex_of_corner[3 * t + c];
        part[v] = part_of(part, v);
      }
    }
  } else {
    for (std::uint32_t v = 0; v < work.positions.size(); ++v) part[v] = part_of(part, v);
  }
  std::vector<std::uint32_t>& count = work.triangles_of_part;
  count.assign(work.positions.size(), 0);
  work.area_of_part.assign(work.positions.size(), 0);
  std::size_t live_parts = 0;
  for (std::uint32_t t : work.live) {
    const std::uint32_t* v = &work.vertex_of_corner[3 * t];
    const Vec3d p = to_double(work.positions[v[0]]);
    const Vec3d cross_product =
        cross(to_double(work.positions[v[1]]) - p, to_double(work.positions[v[2]]) - p);
    live_parts += count[part[v[0]]]++ == 0;
    work.area_of_part[part[v[0]]] += float(length(cross_product));
  }
  return live_parts;
}

void find_owners(WorkMesh& work, const Patches& patches) {
  work.owner_of_vertex.assign(work.positions.size(), kNone);
  for (std::size_t p = 0; p < patches.count(); ++p) {
    for (std::uint32_t t : patches.of(p)) {
      for (std::size_t c = 0; c < 3; ++c) {
        std::uint32_t& owner = work.owner_of_vertex[work.vertex_of_corner[3 * t + c]];
        if (owner == kNone) {
          owner = static_cast<std::uint32_t>(p);
        } else if (owner != p) {
          owner = kShared;
        }
      }
    }
  }
}

class Simplifier {
 public:
  Simplifier(const Mesh& mesh, const Grid& grid, const SimplifyOptions& options)
      : options_(options), work_(make_work(mesh, grid)), normals_(mesh, grid, work_) {
    parallel_both(
        [&] {
          if (options.measures_errors) work_.witnesses = witnesses_of(mesh, work_.positions);
        },
        [&] {
          parallel_both([&] { find_copies(mesh, work_); },
                        [&] {
                          find_parts(work_);
                          find_inside_out(work_);
                        });
        });
    sequence_.grid = grid;
    sequence_.placement = options.placement;
  }

  Result<ContractionSequence> run(SimplifyStatistics* statistics) {
    const std::size_t input_triangles = work_.live.size();
    std::optional<PassLimits> limits;  // once the first one is known
    for (int band = 0; work_.live.size() > 1;) {
      const std::size_t before = work_.live.size();
      const double done = 1 - double(before) / double(input_triangles);
      if (options_.progress && !options_.progress("simplify", done)) {
        return fail(Error::Interrupted, "simplify: interrupted");
      }
      Extent extent;
      bool parts_join = false;
      if (work_.part_count > 1) parts_join = before < kFewTriangles * measure_parts(work_);
      parallel_both([&] { extent = measure_extent(work_); },
                    [&] {
                      if (!limits || limits->begins_band()) start_band(band);
                    });
      const double triangle_area = extent.mean_area;
      const double left = double(before) / double(input_triangles);

      Steering steering;
      steering.placement = options_.placement;
      steering.normal_scale = set_scales(work_, extent, options_.normal_weight, left);
      steering.stays_at_ends = left > kFineShare && before > kFine;
      if (left < kCoarseShare || before < kCoarse) {
        steering.leaves_ends = 1;
        steering.leaves_pair = kCoarseLeavesPair;
      }
      if (!limits) {
        limits.emplace(sampled_limit(steering, triangle_area));
      } else if (stalled_ > 0) {
        const double sampled = sampled_limit(steering, triangle_area);
        if (sampled > limits->limit()) stalled_ = 0;
        limits->raise(sampled);
      }
      const bool last = patches_.count() == 1 && (before <= kLastBand || stalled_ >= kMostStalls);
      steering.cost_limit = last ? kNoLimit : limits->limit();
      const double step = last ? kNoLimit : std::sqrt(limits->limit() / (triangle_area * 6));
      steering.virtual_distance = 2 * step;
      steering.joins_below = last ? kNone : parts_join ? kFewTriangles : kCard;
      steering.turn_distance = 4 * step;
      steering.far_area = far_area_.share() * triangle_area;
      steering.is_alone = options_.threads != 1 && patches_.count() == 1;
      if (!run_pass(steering, input_triangles)) {
        return fail(Error::Interrupted, "simplify: interrupted");
      }

      const double share = double(work_.live.size()) / double(before);
      stalled_ = share > 0.98 ? stalled_ + 1 : 0;
      if (!limits->advance(share, last || stalled_ > 0)) {
        drop_vanished(patches_);
        continue;
      }
      if (statistics) statistics->bands.push_back(band_statistics());
      if (contractions_in_band_ == 0 && sequence_.bands.size() > 1) sequence_.bands.pop_back();
      if (last) break;
      ++band;
    }
    for (WorkLayer& layer : work_.layers)
      sequence_.new_values.push_back(std::move(layer.new_values));
    work_ = {};  // the whole sequence takes its place
    gather_contractions();
    return std::move(sequence_);
  }

 private:
  // Twice as many with each band that is stalled.
  std::uint32_t patch_triangles() const {
    const int doublings = std::clamp(stalled_ + 1 - kMostStalls, 0, 31);
    const std::uint64_t triangles = std::uint64_t(options_.patch_triangles) << doublings;
    return static_cast<std::uint32_t>(
        std::min<std::uint64_t>(triangles, std::numeric_limits<std::uint32_t>::max()));
  }

  // The limit under which kFirstPairs of the pairs lie, from a sample of an eighth of the patches:
  // for the first pass, and where next to nothing cost as little as the last one's, as when all
  // that is flat is gone.
  double sampled_limit(const Steering& steering, double triangle_area) {
    constexpr std::size_t kSample = 16, kStride = 8;
    std::vector<double> costs;
    const std::size_t stride = std::max(kStride, patches_.count() / kSample);
    std::mutex append;
    std::vector<std::size_t> chosen;
    for (std::size_t p = 0; p < patches_.count(); p += stride) chosen.push_back(p);
    Steering of_sample = steering;
    of_sample.is_alone = options_.threads != 1 && chosen.size() == 1;
    std::ranges::reverse(chosen);  // the last one started, the first that is run: it stays loaded
    parallel_for(chosen.size(), [&](std::size_t i) {
      const std::size_t p = chosen[i];
      PatchSimplifier& patch = patch_simplifiers_->local();
      patch.start(work_, patches_.of(p), static_cast<std::uint32_t>(p), of_sample);
      const std::vector<double> own = patch.initial_costs();
      const std::lock_guard<std::mutex> lock(append);
      costs.insert(costs.end(), own.begin(), own.end());
    });
    const double noise = triangle_area * 6 * kGridNoise * kGridNoise;
    if (costs.empty()) return noise;
    const auto most =
        costs.begin() + static_cast<std::ptrdiff_t>(kFirstPairs * double(costs.size()));
    std::nth_element(costs.begin(), most, costs.end());
    return std::max(noise, *most);
  }

  // Who owns a vertex holds for the whole band: a block knows its border by it.
  void start_band(int number) {
    patches_ = partition_triangles(
        work_.positions, work_.vertex_of_corner, work_.live, patch_triangles(), number,
        work_.part_count > 1 ? std::span<const std::uint32_t>(work_.part_of_vertex)
                             : std::span<const std::uint32_t>());
    find_owners(work_, patches_);
    contractions_in_band_ = 0;
    if (!options_.record_bands) return;
    Band& band = sequence_.bands.emplace_back();
    for (std::uint32_t t : patches_.triangles) band.triangles.push_back(TriangleId{t});
    band.first_triangle = patches_.first;
  }

  void drop_vanished(Patches& patches) const {
    std::uint32_t left = 0, next = 0;
    for (std::size_t p = 0; p < patches.count(); ++p) {
      patches.first[p] = left;
      for (; next < patches.first[p + 1]; ++next) {
        const std::uint32_t t = patches.triangles[next];
        if (work_.vertex_of_corner[3 * t] != kNone) patches.triangles[left++] = t;
      }
    }
    patches.first.back() = left;
    patches.triangles.resize(left);
  }

  bool run_pass(const Steering& steering, std::size_t input_triangles) {
    results_.assign(patches_.count(), {});
    SharedProgress progress(options_.progress, "simplify", input_triangles,
                            input_triangles - work_.live.size());
    parallel_for(patches_.count(), [&](std::size_t p) {
      if (progress.stopped()) return;
      const std::span<const std::uint32_t> triangles = patches_.of(p);
      PatchSimplifier& patch = patch_simplifiers_->local();
      patch.start(work_, triangles, static_cast<std::uint32_t>(p), steering);
      results_[p] = patch.run(progress);
      progress.advance(triangles.size() - results_[p].triangles_left);
    });
    patch_simplifiers_.emplace();  // their memory is for what follows
    if (progress.stopped()) return false;
    FarCounts far_counts;
    for (const PatchResult& result : results_) far_counts.add(result.far_counts);
    far_area_.learn(far_counts);
    const std::size_t first_normal = normals_.value_count();
    number_new_values();
    for (const PatchResult& result : results_) {
      for (const PatchContraction& own : result.contractions) {
        normals_.note_contraction(static_cast<std::uint32_t>(own.contraction.removed),
                                  static_cast<std::uint32_t>(own.contraction.kept));
      }
    }
    parallel_both([&] { append_contractions(); },
                  [&] {
                    join_contracted_parts();
                    std::erase_if(work_.live, [&](std::uint32_t t) {
                      return work_.vertex_of_corner[3 * t] == kNone;
                    });
                  });
    results_.clear();
    normals_.fit(first_normal);
    return true;
  }

  // Patches numbered their new attribute values on their own; now that all are known, in the order
  // of the patches, they get their final ids.
  void number_new_values() {
    const std::size_t layers = work_.layers.size();
    first_new_.assign(layers * patches_.count(), 0);
    for (std::size_t l = 0; l < layers; ++l) {
      WorkLayer& layer = work_.layers[l];
      for (std::size_t p = 0; p < patches_.count(); ++p) {
        first_new_[p * layers + l] = static_cast<std::uint32_t>(layer.value_count());
        std::vector<float>& values = results_[p].new_values[l];
        layer.new_values.insert(layer.new_values.end(), values.begin(), values.end());
        values = {};
      }
    }
    parallel_for(patches_.count(), [&](std::size_t p) {
      for (std::uint32_t t : patches_.of(p)) {
        if (work_.vertex_of_corner[3 * t] == kNone) continue;
        for (std::size_t l = 0; l < layers; ++l) {
          for (std::size_t c = 0; c < 3; ++c) {
            std::uint32_t& id = work_.layers[l].of_corner[3 * t + c];
            if (id >= kLocalValue) id = id - kLocalValue + first_new_[p * layers + l];
          }
        }
      }
      for (AttributeChange& change : results_[p].changes) {
        for (AttributeId* id : {&change.from, &change.to}) {
          const std::uint32_t raw = static_cast<std::uint32_t>(*id);
          if (raw >= kLocalValue) {
            *id = AttributeId{raw - kLocalValue + first_new_[p * layers + change.layer]};
          }
        }
      }
    });
  }

  // A contraction of the pass.
  struct At {
    double key;
    std::uint32_t patch, index;
  };
  // Patch by patch they are in order; `begin_of_patch` says where each of the patches `first` to
  // `end` begins, and where the last one ends. Of equal keys the lower patch's come first.
  static void merge(At* order, std::span<const std::size_t> begin_of_patch, std::size_t first,
                    std::size_t end) {
    if (end - first < 2) return;
    const std::size_t middle = first + (end - first) / 2;
    parallel_both([&] { merge(order, begin_of_patch, first, middle); },
                  [&] { merge(order, begin_of_patch, middle, end); });
    std::inplace_merge(order + begin_of_patch[first], order + begin_of_patch[middle],
                       order + begin_of_patch[end],
                       [](const At& a, const At& b) { return a.key < b.key; });
  }

  // One order for the pass: by cost, which never falls inside a patch, then by patch.
  void append_contractions() {
    std::size_t contraction_count = 0, change_count = 0;
    for (const PatchResult& result : results_) {
      contraction_count += result.contractions.size();
      change_count += result.changes.size();
    }
    std::vector<AttributeChange>& all_changes = changes_of_pass_.emplace_back();
    all_changes.reserve(change_count);
    std::vector<At> order;
    order.reserve(contraction_count);
    std::vector<std::size_t> begin_of_patch = {0};
    for (std::uint32_t p = 0; p < results_.size(); ++p) {
      for (std::uint32_t i = 0; i < results_[p].contractions.size(); ++i) {
        order.push_back({results_[p].contractions[i].key, p, i});
      }
      begin_of_patch.push_back(order.size());
    }
    merge(order.data(), begin_of_patch, 0, results_.size());
    contractions_in_band_ += static_cast<std::uint32_t>(order.size());
    if (options_.record_bands) {
      sequence_.bands.back().contraction_count = contractions_in_band_;
      for (const At& at : order) sequence_.patch_of_contraction.push_back(at.patch);
    }
    std::vector<Contraction>& contractions = contractions_of_pass_.emplace_back();
    contractions.reserve(contraction_count);
    for (const At& at : order) {
      const PatchResult& from = results_[at.patch];
      Contraction contraction = from.contractions[at.index].contraction;
      const auto changes =
          std::span(from.changes).subspan(contraction.first_change, contraction.change_count);
      const auto derived =
          std::span(from.derived).subspan(contraction.first_derived, contraction.derived_count);
      contraction.first_change = static_cast<std::uint32_t>(change_count_ + all_changes.size());
      contraction.first_derived = static_cast<std::uint32_t>(sequence_.derived.size());
      for (const AttributeChange& change : changes) all_changes.push_back(change);
      for (TriangleId triangle : derived) sequence_.derived.push_back(triangle);
      worst_surface_ = std::max(worst_surface_, contraction.error.surface);
      contractions.push_back(contraction);
    }
    change_count_ += change_count;
  }

  // In any order: the parts are the same.
  void join_contracted_parts() {
    for (const PatchResult& result : results_) {
      if (work_.part_count < 2) return;
      for (const PatchContraction& own : result.contractions) {
        join_parts(work_, static_cast<std::uint32_t>(own.contraction.removed),
                   static_cast<std::uint32_t>(own.contraction.kept));
      }
    }
  }

  BandStatistics band_statistics() const {
    return {static_cast<std::uint32_t>(patches_.count()), contractions_in_band_,
            static_cast<std::uint32_t>(work_.live.size()),
            static_cast<float>(double(worst_surface_) * sequence_.grid.step)};
  }

  // Errors from grid units to model units.
  void gather_contractions() {
    std::size_t count = 0;
    for (const auto& of_pass : contractions_of_pass_) count += of_pass.size();
    sequence_.contractions.reserve(count);
    for (auto& of_pass : contractions_of_pass_) {
      for (Contraction& contraction : of_pass) {
        LevelError& error = contraction.error;
        error.surface = static_cast<float>(double(error.surface) * sequence_.grid.step);
        error.line = static_cast<float>(double(error.line) * sequence_.grid.step);
        sequence_.contractions.push_back(contraction);
      }
      of_pass = {};
    }
    sequence_.changes.reserve(change_count_);
    for (auto& of_pass : changes_of_pass_) {
      sequence_.changes.insert(sequence_.changes.end(), of_pass.begin(), of_pass.end());
      of_pass = {};
    }
  }

  const SimplifyOptions& options_;
  WorkMesh work_;
  NormalFit normals_;
  Patches patches_;
  std::vector<PatchResult> results_;
  std::vector<std::uint32_t> first_new_;  // patch by patch, layer by layer
  std::optional<PerThread<PatchSimplifier>> patch_simplifiers_{std::in_place};
  FarArea far_area_;
  int stalled_ = 0;
  std::uint32_t contractions_in_band_ = 0;
  float worst_surface_ = 0;
  std::vector<std::vector<Contraction>> contractions_of_pass_;  // errors in grid units
  std::vector<std::vector<AttributeChange>> changes_of_pass_;
  std::size_t change_count_ = 0;
  ContractionSequence sequence_;  // contractions, changes and new values at the end
};

}  // namespace
}  // namespace simplification

Result<ContractionSequence> simplify(const Mesh& snapped, const Grid& grid,
                                     const SimplifyOptions& options,
                                     SimplifyStatistics* statistics) {
  if (options.patch_triangles == 0) return fail(Error::Invalid, "patches of no triangles");
  if (!(options.normal_weight >= 0) || !std::isfinite(options.normal_weight)) {
    return fail(Error::Invalid, "a weight of normals that is negative, or no number");
  }
  return run_on(options.threads,
                [&] { return simplification::Simplifier(snapped, grid, options).run(statistics); });
}

}  // namespace crease
