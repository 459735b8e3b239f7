#include "cli/report_page.h"

#include "cli/curves_svg.h"
#include "cli/fields.h"
#include "cli/text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>
#include <vector>

namespace crease::cli {

namespace {

constexpr const char* kPageStyle =
#include "cli/report_style.inc"
    ;

std::string base64(std::span<const std::byte> bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k > bytes.size() ? '=' : kDigits[group >> (18 - 6 * k) & 63];
    }
  }
  return text;
}

std::string printed(const char* pattern, double value) {
  char text[48];
  std::snprintf(text, sizeof text, pattern, value);
  return text;
}

// Digits in groups that stay on one line.
std::string whole_number(std::uint64_t count) {
  std::string text;
  for (const char c : grouped(count)) text += c == ' ' ? "\u00A0" : std::string(1, c);
  return text;
}
std::string cell_count(const Json& count) {
  return whole_number(count.get<std::uint64_t>());
}

std::string bits_as_bytes(double bits) {
  return in_bytes(static_cast<std::uint64_t>(std::llround(bits / 8)));
}

std::string of_diagonal(double length, double diagonal) {
  return diagonal > 0 ? printed("%.3g %%", 100 * length / diagonal) : "";
}

// Rows of cells, the first column left-aligned.
class Table {
 public:
  explicit Table(const std::vector<std::string>& heads) {
    html_ = "<div class=\"scroll\"><table><thead><tr>";
    for (const std::string& head : heads) html_ += "<th>" + escaped(head) + "</th>";
    html_ += "</tr></thead><tbody>\n";
  }
  void row(const std::vector<std::string>& cells) {
    html_ += "<tr>";
    for (const std::string& cell : cells) html_ += "<td>" + escaped(cell) + "</td>";
    html_ += "</tr>\n";
  }
  std::string html() const { return html_ + "</tbody></table></div>\n"; }

 private:
  std::string html_;
};

std::string fact(const char* name, const std::string& value, const std::string& more = "") {
  return std::string("<div><dt>") + name + "</dt><dd>" + escaped(value) +
         (more.empty() ? "" : "<small>" + escaped(more) + "</small>") + "</dd></div>\n";
}

std::string box_text(const Json& bounds) {
  std::string text;
  for (std::size_t i = 0; i < 3; ++i) {
    const double side = bounds["high"][i].get<double>() - bounds["low"][i].get<double>();
    text += (i > 0 ? " ×\u00A0" : "") + in_length(side);
  }
  return text;
}

std::string facts_html(const PageContent& page) {
  const Json& f = page.facts;
  std::string names;
  for (const Json& a : f["attributes"]) {
    names += (names.empty() ? "" : ", ") + a["name"].get<std::string>();
  }
  return "<dl>\n" +
         fact("triangles", cell_count(f["triangles"]),
              cell_count(f["sn_triangles"]) + " smooth (SN), " + cell_count(f["fn_triangles"]) +
                  " flat (FN), " + cell_count(f["nsn_triangles"]) + " mixed (NSN)") +
         fact("vertices", cell_count(f["vertices"]),
              cell_count(f["sn_vertices"]) + " with one normal, " + cell_count(f["nsn_vertices"]) +
                  " with several") +
         fact("file", in_bytes(f["bytes"].get<std::uint64_t>()),
              printed("%.2f bits a vertex", f["bits_per_vertex"]["total"].get<double>())) +
         fact("blocks", cell_count(f["blocks"]),
              std::to_string(f["bands"].size()) + " bands and the base") +
         fact("box, model units", box_text(f["bounds"]),
              "diagonal " + in_length(page.levels.diagonal)) +
         fact("grid", in_length(f["precision"].get<double>()), "step of positions, model units") +
         fact("parts and materials",
              cell_count(f["parts"]) + " / " + std::to_string(f["materials"].size())) +
         fact("attributes", std::to_string(f["attributes"].size()), names) + "</dl>\n";
}

std::string level_figure(const ReportLevel& level, double diagonal, const std::string& model) {
  std::string html = "<figure>";
  if (!level.png.empty()) {
    html += "<img alt=\"" + escaped(model + ", " + level.name) + "\" src=\"data:image/png;base64," +
            base64(level.png) + "\"/>";
  }
  html += "<figcaption><b>" + escaped(level.name) + "</b> · " + whole_number(level.triangles) +
          " triangles";
  if (level.measured) {
    const double most = hausdorff(*level.measured);
    html += "<span>off by at most " + in_length(most) + " (" + of_diagonal(most, diagonal) +
            " of the diagonal), normals by " + in_degrees(level.measured->normal_deviation.mean) +
            " on average</span>";
  } else {
    html += "<span>" + in_bytes(level.bytes_needed) + " of the file</span>";
  }
  return html + "</figcaption></figure>\n";
}

std::string levels_table(const ReportLevels& all) {
  Table table({"level", "triangles", "vertices", "SN", "FN", "NSN", "first bytes of the file",
               "mean distance", "of diagonal", "largest distance", "of diagonal", "normals, mean",
               "95 % below", "file says", "stopped by"});
  for (const ReportLevel& level : all.levels) {
    std::vector<std::string> row = {level.name,
                                    whole_number(level.triangles),
                                    whole_number(level.vertices),
                                    whole_number(level.sn_triangles),
                                    whole_number(level.fn_triangles),
                                    whole_number(level.nsn_triangles),
                                    in_bytes(level.bytes_needed)};
    if (level.measured) {
      const Comparison& m = *level.measured;
      const double mean = (m.distance.a_to_b.mean + m.distance.b_to_a.mean) / 2;
      for (const std::string& cell :
           {in_length(mean), of_diagonal(mean, all.diagonal), in_length(hausdorff(m)),
            of_diagonal(hausdorff(m), all.diagonal), in_degrees(m.normal_deviation.mean),
            in_degrees(m.normal_deviation.p95)}) {
        row.push_back(cell);
      }
    } else {
      row.insert(row.end(), 6, "–");
    }
    row.push_back(in_length(level.recorded.surface));
    row.push_back(name_of(level.stopped_by));
    table.row(row);
  }
  return table.html();
}

std::string in_unit(double deviation, DeviationUnit unit) {
  switch (unit) {
    case DeviationUnit::Degrees:
      return in_degrees(deviation);
    case DeviationUnit::Share:
      return printed("%.3g %%", 100 * deviation);
    case DeviationUnit::Values:
      break;
  }
  return printed("%.3g", deviation);
}

// How far what the levels carry besides normals has moved; empty where they carry nothing.
std::string level_attributes_table(const std::vector<ReportLevel>& levels) {
  const auto carries = [](const ReportLevel& level) {
    return level.measured && !level.measured->attributes.empty();
  };
  const auto first = std::find_if(levels.begin(), levels.end(), carries);
  if (first == levels.end()) return "";
  std::vector<std::string> heads = {"level"};
  for (const AttributeDeviation& attribute : first->measured->attributes) {
    const bool differs = attribute.unit == DeviationUnit::Share;
    heads.push_back(attribute.name + (differs ? " differs on" : ", mean"));
    if (!differs) heads.push_back("95 % below");
  }
  Table table(heads);
  for (const ReportLevel& level : levels) {
    if (!carries(level)) continue;
    std::vector<std::string> row = {level.name};
    for (const AttributeDeviation& attribute : level.measured->attributes) {
      row.push_back(in_unit(attribute.spread.mean, attribute.unit));
      if (attribute.unit == DeviationUnit::Share) continue;
      row.push_back(in_unit(attribute.spread.p95, attribute.unit));
    }
    table.row(row);
  }
  return table.html();
}

using LevelValue = double (*)(const Comparison&);

Curve measured_curve(const char* name, int color, const ReportLevels& all, bool by_bytes,
                     LevelValue value) {
  Curve curve{name, color, false, {}};
  for (const ReportLevel& level : all.levels) {
    if (!level.measured) continue;
    const double x = static_cast<double>(by_bytes ? level.bytes_needed : level.triangles);
    curve.points.emplace_back(x, value(*level.measured));
  }
  return curve;
}

Curve recorded_curve(const PageContent& page, bool by_bytes, const char* error) {
  Curve curve{"stored in the file", 2, true, {}};
  const Json& bands = page.facts["bands"];
  const double coarsest = static_cast<double>(page.levels.levels.back().triangles);
  for (std::size_t b = 0; b < bands.size(); ++b) {
    // The measured part alone, and little more.
    if (b > 0 && bands[b]["triangles_after"].get<double>() < coarsest / 3) break;
    const double x = by_bytes ? static_cast<double>(page.levels.bytes_of_band[b])
                              : bands[b]["triangles_after"].get<double>();
    curve.points.emplace_back(x, bands[b]["error"][error].get<double>());
  }
  return curve;
}

std::string plots_html(const PageContent& page) {
  std::string html = "<div class=\"plots\">\n";
  for (const bool by_bytes : {false, true}) {
    const Axis x = by_bytes ? Axis{"first bytes of the file", "", true} : Axis{"triangles", ""};
    const std::string against = by_bytes ? " against bytes" : " against triangles";
    html +=
        curves_svg({"Distance from the original" + against,
                    x,
                    {"distance", "model units"},
                    {measured_curve("largest measured", 0, page.levels, by_bytes,
                                    [](const Comparison& m) { return hausdorff(m); }),
                     measured_curve("mean measured", 1, page.levels, by_bytes,
                                    [](const Comparison& m) {
                                      return (m.distance.a_to_b.mean + m.distance.b_to_a.mean) / 2;
                                    }),
                     recorded_curve(page, by_bytes, "surface")}});
    html +=
        curves_svg({"Deviation of normals" + against,
                    x,
                    {"angle", "degrees"},
                    {measured_curve("95 % below, measured", 0, page.levels, by_bytes,
                                    [](const Comparison& m) { return m.normal_deviation.p95; }),
                     measured_curve("mean measured", 1, page.levels, by_bytes,
                                    [](const Comparison& m) { return m.normal_deviation.mean; }),
                     recorded_curve(page, by_bytes, "degrees")}});
  }
  return html + "</div>\n";
}

std::string streams_table(const Json& f) {
  struct Stream {
    const char* key;
    const char* holds;
  };
  static constexpr Stream kStreams[] = {{"roots", "vertices and triangles that no split makes"},
                                        {"flags", "which vertices are split"},
                                        {"shapes", "triangles that a split adds and moves"},
                                        {"positions", "positions"},
                                        {"categories", "materials, parts, derived triangles"},
                                        {"values", "values of attributes"},
                                        {"labels", "patches of the next band"}};
  const double vertices = f["vertices"].get<double>(), bytes = f["bytes"].get<double>();
  Table table({"stream", "what", "bytes", "bits a vertex", "of the file"});
  const auto add = [&](const char* name, const char* what, double bits) {
    table.row({name, what, bits_as_bytes(bits), printed("%.3f", bits / vertices),
               printed("%.1f %%", 100 * bits / (8 * bytes))});
  };
  for (const Stream& stream : kStreams) {
    add(stream.key, stream.holds, f["streams"][stream.key].get<double>());
  }
  add("container", "head, directory, checksums", 8 * f["container_bytes"].get<double>());
  add("all", "", 8 * bytes);
  return table.html();
}

std::string bands_table(const PageContent& page) {
  const Json& f = page.facts;
  Table table({"band", "down to triangles", "blocks", "splits", "distance", "normals",
               "connectivity", "positions", "attributes", "all", "first bytes of the file"});
  const auto sizes = [](const Json& bits) {
    const auto of = [&](const char* key) { return bits[key].get<double>(); };
    const double connectivity = of("roots") + of("flags") + of("shapes") + of("labels");
    const double attributes = of("categories") + of("values");
    return std::vector<std::string>{bits_as_bytes(connectivity), bits_as_bytes(of("positions")),
                                    bits_as_bytes(attributes),
                                    bits_as_bytes(connectivity + of("positions") + attributes)};
  };
  const auto add = [&](std::vector<std::string> row, const Json& bits, const std::string& end) {
    for (std::string& size : sizes(bits)) row.push_back(std::move(size));
    row.push_back(end);
    table.row(row);
  };
  const Json& bands = f["bands"];
  for (std::size_t b = 0; b < bands.size(); ++b) {
    const Json& band = bands[b];
    const std::uint64_t end =
        b == 0 ? f["bytes"].get<std::uint64_t>() : page.levels.bytes_of_band[b - 1];
    add({std::to_string(b), cell_count(band["triangles_after"]), cell_count(band["patches"]),
         cell_count(band["contractions"]), in_length(band["error"]["surface"].get<double>()),
         in_degrees(band["error"]["degrees"].get<double>())},
        band["bits"], in_bytes(end));
  }
  add({"base", "", "1", "", "", ""}, f["base_bits"],
      in_bytes(bands.empty() ? f["bytes"].get<std::uint64_t>() : page.levels.bytes_of_band.back()));
  return table.html();
}

std::string linear_table(const Json& f) {
  const Json& linear = f["linear_bytes"];
  const double ours = linear["crease"].get<double>(), triangles = f["triangles"].get<double>();
  Table table({"arrays at full resolution", "bytes", "bytes a triangle", "crease is"});
  const auto add = [&](const char* name, const char* key, bool compares) {
    const double bytes = linear[key].get<double>();
    table.row({name, in_bytes(linear[key].get<std::uint64_t>()), printed("%.1f", bytes / triangles),
               compares && bytes > 0 ? printed("%.0f %%", 100 * ours / bytes) : ""});
  };
  add("crease: normals by kind of triangle", "crease", false);
  add("wedges (Hoppe)", "wedge", true);
  add("a vertex for every position and normal", "replicated", true);
  add("records that switch levels, besides", "records", false);
  return table.html();
}

std::string attributes_table(const Json& f) {
  Table table({"attribute", "role", "interpolation", "numbers", "values"});
  for (const Json& a : f["attributes"]) {
    table.row({a["name"].get<std::string>(), a["role"].get<std::string>(),
               a["interpolation"].get<std::string>(), std::to_string(a["dimension"].get<int>()),
               cell_count(a["values"])});
  }
  return table.html();
}

std::string section(const char* title, const char* says, const std::string& html) {
  return std::string("<h2>") + title + "</h2>\n" +
         (*says != 0 ? "<p class=\"soft\">" + std::string(says) + "</p>\n" : "") + html;
}

std::string levels_html(const PageContent& page) {
  std::string html = "<div class=\"levels\">\n";
  for (const ReportLevel& level : page.levels.levels) {
    html += level_figure(level, page.levels.diagonal, page.title);
  }
  html += "</div>\n";
  if (!page.levels.no_pictures.empty()) {
    html += "<p>No pictures: " + escaped(page.levels.no_pictures) + "</p>\n";
  }
  return html;
}

}  // namespace

std::string report_page(const PageContent& page) {
  const std::string title = escaped(page.title);
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n<title>" +
      title + "</title>\n<style>" + kPageStyle + "</style></head>\n<body><main>\n<h1>" + title +
      "</h1>\n<p class=\"soft\">A multiresolution triangle mesh: any level from one file.</p>\n" +
      facts_html(page);
  html += section("Levels", "Each has the share of the triangles that stands below it.",
                  levels_html(page));
  html +=
      section("Errors",
              "Measured between the surfaces, both ways, beside the estimates that the file "
              "stores. Bytes are those from the start of the file to the last that a level needs.",
              plots_html(page));
  html += "<p></p>\n" + levels_table(page.levels);
  if (const std::string drift = level_attributes_table(page.levels.levels); !drift.empty()) {
    html += section("What is on the surface",
                    "How far the levels' attributes are from the original's at the same place, in "
                    "their own units (texture coordinates: 1 is the image's side; colours: 0 to "
                    "1), and the share of the surface that is of another material or part.",
                    drift);
  }
  html += section("Where the bytes go", "",
                  "<div class=\"words\">" + streams_table(page.facts) + "</div>\n");
  html += section("Bands",
                  "From fine to coarse; what each adds to the next coarser one, and the errors "
                  "stored at its coarse end.",
                  bands_table(page));
  html += section("Memory at run time", "Positions, normals and indices as a renderer needs them.",
                  linear_table(page.facts));
  html += section("Attributes", "", attributes_table(page.facts));
  if (!page.import_lines.empty()) {
    html += section("Import", "", "<pre>" + escaped(page.import_lines) + "</pre>\n");
  }
  return html + "<footer>Made by crease report, version " CREASE_VERSION
                ".</footer>\n</main></body></html>\n";
}

}  // namespace crease::cli
