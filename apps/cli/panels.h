// The panels of a picture and the meshes they are drawn from.
#pragma once

#include "cli/level.h"
#include "cli/model.h"
#include "crease/adaptive_mesh.h"
#include "crease/render.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace crease::cli {

struct PanelOptions {
  std::vector<double> ratios;  // a panel each; empty: one panel by `level`
  LevelOptions level;
  std::optional<ViewParameters> view;  // instead of both: one panel, as fine as this needs it
  bool control = false;  // after the levels, each again with one averaged normal a vertex
  bool titles = true;
  bool file_names = false;  // in titles of levels; those of views have them anyway
  // For Coloring::Error: measured distances; of a view, pixels on its screen. For Coloring::Level.
  bool errors_of_positions = false, levels_of_positions = false;
  std::string up = "auto";  // --up
  ReadOptions read;

  std::size_t level_count() const { return std::max<std::size_t>(1, ratios.size()); }
  std::size_t panel_count() const { return level_count() * (control ? 2 : 1); }  // of a file
  // So that each control stands below its level, and a single one beside it.
  std::size_t control_columns() const { return level_count() == 1 ? 2 : level_count(); }
};

class Panels {
 public:
  Status add_file(const std::filesystem::path& path, const PanelOptions& options,
                  const Common& common);

  std::span<const Panel> list() const { return panels_; }
  const Json& json() const { return json_; }                // one object a panel
  std::uint64_t bytes_read() const { return bytes_read_; }  // of .crease files
  UpAxis up() const { return first_up_; }                   // of the first file that knows

 private:
  // What a panel's views point into.
  struct Source {
    std::unique_ptr<ProgressiveMesh> progressive;
    std::unique_ptr<MeshDrawArrays> arrays;
    std::unique_ptr<AdaptiveMesh> adaptive;
    std::vector<float> errors, levels;
    std::vector<ImageFile> images;
  };
  Status add_view(const std::filesystem::path& path, const PanelOptions& options,
                  const Common& common);
  // `full` has the images.
  void add_level(ProgressiveMesh mesh, const Mesh& full, std::size_t full_count,
                 const std::string& name, const PanelOptions& options, const Common& common);
  void add_control(const Mesh& level, const std::string& name, const PanelOptions& options,
                   float level_share);
  void learn_up(UpAxis up) {
    up_ = up;
    if (first_up_ == UpAxis::Unknown) first_up_ = up;
  }
  void add(Source source, const std::string& title, Json json, const PanelOptions& options,
           float level_share);

  std::deque<Source> sources_;
  std::vector<Panel> panels_;
  Json json_ = Json::array();
  std::uint64_t bytes_read_ = 0;
  UpAxis up_ = UpAxis::Unknown, first_up_ = UpAxis::Unknown;  // of the file in hand; up()
  std::uint32_t file_count_ = 0;
};

// One normal a vertex: the average of the corners' stored normals, weighted by their angles. What a
// level of detail looks like when shading discontinuities are ignored (DB03 figures 1 and 13).
Mesh with_averaged_normals(Mesh mesh);

}  // namespace crease::cli
