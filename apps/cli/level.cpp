#include "cli/level.h"

#include "cli/console.h"
#include "cli/fields.h"
#include "cli/number_check.h"
#include "cli/text.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace crease::cli {

void add_level_options(CLI::App& command, LevelOptions& options) {
  CLI::Option* triangles =
      command.add_option("--triangles", options.triangles, "the finest level with at most N")
          ->type_name("N")
          ->check(number_from(1));
  CLI::Option* ratio =
      command.add_option("--ratio", options.ratio, "share of the triangles, above 0 and up to 1")
          ->type_name("R")
          ->check(number_above(0, 1));
  CLI::Option* error =
      command
          .add_option(
              "--error", options.error,
              "the coarsest level whose measured distance from the full mesh, both ways, is "
              "at most LENGTH, and whose materials and textures are where they belong")
          ->type_name("LENGTH")
          ->check(number_from(0));
  triangles->excludes(ratio);
  triangles->excludes(error);
  ratio->excludes(error);
  command
      .add_option("--samples", options.samples,
                  "points on each surface for means and normals; 0 measures nothing")
      ->type_name("N")
      ->check(sample_count(0))
      ->capture_default_str();
}

const char* name_of(StoppedBy stop) {
  switch (stop) {
    case StoppedBy::View:
      return "view";
    case StoppedBy::Triangles:
      return "triangles";
    case StoppedBy::Error:
      return "error";
    case StoppedBy::Base:
      return "base";
    case StoppedBy::Topology:
      return "topology";
  }
  return "";
}

namespace {

CompareOptions options_of(std::size_t samples, const Common& common) {
  CompareOptions options;
  options.samples = samples;
  options.threads = common.threads;
  options.progress = progress_bar(common);
  return options;
}

// The last contractions may take the last triangle; a level for others has at least one.
void keep_a_triangle(ProgressiveMesh& mesh) {
  while (mesh.triangle_count() == 0 && mesh.applied() > 0) mesh.set_applied(mesh.applied() - 1);
}

Chosen choose_by_count(ProgressiveMesh& mesh, std::size_t count) {
  mesh.set_triangle_count(count);
  keep_a_triangle(mesh);
  Chosen chosen;
  chosen.target_met = mesh.triangle_count() <= count;
  chosen.stopped_by = chosen.target_met ? StoppedBy::Triangles : StoppedBy::Topology;
  return chosen;
}

// Looks for the coarsest level within `limit`. Errors grow along the sequence, though not strictly,
// so this brackets from where the recorded error points to and halves the bracket until it is one
// contraction or a hundredth of the triangles wide. Of what it returns no point is too far.
//
// No distance tells that a patch of another material is gone, or a window that stood on a wall,
// where something else lies. Recorded errors do, but as sums over bands: up to sixteen times what
// is measured on surfaces that have nothing of that kind. Where they say more, no level is tried.
// Nor do they see a chart that another one has grown over: of what is painted no more than a
// twentieth may show another material, or a place of its texture that is far from its own.
class ErrorSearch {
 public:
  ErrorSearch(ProgressiveMesh& mesh, const Mesh& full, double limit, std::size_t samples,
              const Common& common)
      : mesh_(mesh), full_(full), limit_(limit), samples_(samples), common_(common) {
    for (const AttributeLayer& layer : full.layers) {
      if (layer.role == AttributeRole::TexCoord) textures_.push_back({layer.name, unit_of(layer)});
    }
  }

  Result<Chosen> run() {
    std::size_t good = 0;                             // full resolution is within any limit
    std::size_t bad = mesh_.contraction_count() + 1;  // no level
    mesh_.set_applied(mesh_.contraction_count());
    keep_a_triangle(mesh_);
    const std::size_t last = mesh_.applied();
    const std::size_t base = std::min(last, mesh_.applied_for_view(most_recorded()));

    const auto try_level = [&](std::size_t applied) {
      (is_within(applied) ? good : bad) = applied;
    };
    try_level(std::min(base, mesh_.applied_for_error(static_cast<float>(limit_))));
    // Coarser by a third at a time while it is good, finer by a half while it is not.
    while (bad > base && good < base && !interrupted()) {
      const std::size_t before = good;
      try_level(std::min(base, std::max(good + 1, applied_at(triangles_at(good) * 2 / 3))));
      if (good == before) break;
    }
    while (good == 0 && bad > 1 && bad <= base && !interrupted()) {
      const std::size_t finer = applied_at(triangles_at(bad) * 3 / 2);
      if (finer == 0) break;
      try_level(std::min(finer, bad - 1));
    }
    while (bad > good + 1 && bad <= base && !interrupted() &&
           (triangles_at(good) - triangles_at(bad)) * 100 > triangles_at(good)) {
      try_level(good + (bad - good) / 2);
    }
    if (interrupted()) return interrupted_failure();

    mesh_.set_applied(good);
    log(common_, "  of " + std::to_string(tries_) + (tries_ == 1 ? " level" : " levels") +
                     " measured, " + grouped(mesh_.triangle_count()) +
                     " triangles are the fewest within " + in_length(limit_));
    const Result<Comparison> measured = measure_level(full_, mesh_.extract(), samples_, common_);
    if (!measured.ok()) return measured.failure();
    Chosen chosen;
    chosen.measured = *measured;
    chosen.stopped_by = good == last ? StoppedBy::Base : StoppedBy::Error;
    return chosen;
  }

 private:
  static constexpr double kMostRecorded = 16, kMostMoved = 4, kMostWrong = 0.05;
  static constexpr std::size_t kPaintSamples = 20'000;  // for shares of a twentieth
  static constexpr double kRounding = 1e-6;  // of the diagonal: recorded where nothing changes

  struct Texture {
    std::string name;  // of the layer
    double unit = 0;   // how long one of it is on the surface; 0: nothing is painted
  };

  double unit_of(const AttributeLayer& layer) const {
    double area = 0, painted = 0;
    for (std::size_t t = 0; t < full_.triangle_count(); ++t) {
      const auto at = [&](std::size_t c) {
        return full_.positions[index_of(full_.triangles[t][c])];
      };
      const auto value = [&](std::size_t c) { return layer.value(layer.of_corner[3 * t + c]); };
      area += length(cross(at(1) - at(0), at(2) - at(0)));
      const auto a = value(0), b = value(1), c = value(2);
      painted += std::abs(double(b[0] - a[0]) * double(c[1] - a[1]) -
                          double(c[0] - a[0]) * double(b[1] - a[1]));
    }
    return painted > 0 ? std::sqrt(area / painted) : 0;
  }
  double rounding() const {
    Vec3d low = full_.positions.front(), high = low;
    for (const Vec3d& p : full_.positions) {
      for (int i = 0; i < 3; ++i) {
        low[i] = std::min(low[i], p[i]);
        high[i] = std::max(high[i], p[i]);
      }
    }
    return kRounding * length(high - low);
  }
  float most_recorded() const { return static_cast<float>(kMostRecorded * limit_ + rounding()); }
  std::size_t triangles_at(std::size_t applied) {
    mesh_.set_applied(applied);
    return mesh_.triangle_count();
  }
  std::size_t applied_at(std::size_t triangles) {
    mesh_.set_triangle_count(std::max<std::size_t>(1, triangles));
    keep_a_triangle(mesh_);
    return mesh_.applied();
  }
  bool is_within(std::size_t applied) {
    mesh_.set_applied(applied);
    const Result<bool> within =
        meshes_within(full_, mesh_.extract(), limit_, options_of(samples_, common_));
    wipe_progress_bar();
    if (!within.ok()) return false;  // interrupted, which run() sees
    ++tries_;
    return *within && is_painted_right();
  }
  bool is_painted_right() {
    if (textures_.empty() && full_.materials.size() < 2) return true;
    const Result<Comparison> measured =
        measure_level(full_, mesh_.extract(), std::min(samples_, kPaintSamples), common_);
    if (!measured.ok()) return false;
    for (const AttributeDeviation& of : measured->attributes) {
      if (of.unit == DeviationUnit::Share && of.name == "material" && of.spread.mean > kMostWrong) {
        return false;
      }
      for (const Texture& texture : textures_) {
        if (of.name != texture.name) continue;
        if (of.spread.p95 * texture.unit > kMostMoved * limit_ + rounding()) return false;
      }
    }
    return true;
  }

  int tries_ = 0;
  std::vector<Texture> textures_;
  ProgressiveMesh& mesh_;
  const Mesh& full_;
  double limit_;
  std::size_t samples_;
  const Common& common_;
};

}  // namespace

std::string shortfall_of(std::size_t triangles) {
  return "target not met: the coarsest level has " + grouped(triangles) + " triangles";
}

Result<Chosen> choose_level(ProgressiveMesh& mesh, const Mesh& full, const LevelOptions& asked,
                            const Common& common) {
  if (asked.triangles) return choose_by_count(mesh, *asked.triangles);
  if (asked.ratio) {
    const double count = *asked.ratio * static_cast<double>(mesh.full_triangle_count());
    return choose_by_count(mesh,
                           std::max<std::size_t>(1, static_cast<std::size_t>(std::llround(count))));
  }
  if (asked.error) {
    if (asked.samples == 0) {
      return fail(Error::CommandLine, "--error measures: --samples must be above 0");
    }
    return ErrorSearch(mesh, full, *asked.error, asked.samples, common).run();
  }
  return choose_by_count(mesh, mesh.full_triangle_count());
}

Result<Comparison> measure_level(const Mesh& full, const Mesh& level, std::size_t samples,
                                 const Common& common) {
  Result<Comparison> measured = compare_meshes(full, level, options_of(samples, common));
  wipe_progress_bar();
  if (interrupted()) return interrupted_failure();
  return measured;
}

}  // namespace crease::cli
