#include "cli/fields.h"

#include "cli/text.h"
#include "cli/up_option.h"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace crease::cli {

namespace {

Json to_json(const DeviationSpread& spread) {
  return {{"mean", spread.mean}, {"p95", spread.p95}, {"max", spread.max}};
}

const char* name_of(DeviationUnit unit) {
  switch (unit) {
    case DeviationUnit::Values:
      return "values";
    case DeviationUnit::Degrees:
      return "degrees";
    case DeviationUnit::Share:
      break;
  }
  return "share";
}

Json to_json(const std::vector<AttributeDeviation>& attributes) {
  Json all = Json::array();
  for (const AttributeDeviation& attribute : attributes) {
    Json json = {{"name", attribute.name}, {"unit", name_of(attribute.unit)}};
    json.update(to_json(attribute.spread));
    all.push_back(std::move(json));
  }
  return all;
}

}  // namespace

Json to_json(const LevelError& error) {
  return {{"surface", error.surface},
          {"line", error.line},
          {"degrees", error.degrees},
          {"texture", error.texture}};
}

Json to_json(const Comparison& c) {
  const auto both = [](double a_to_b, double b_to_a) {
    return Json{{"a_to_b", a_to_b}, {"b_to_a", b_to_a}};
  };
  const Spread& to = c.distance.a_to_b;
  const Spread& from = c.distance.b_to_a;
  const double diagonal = c.diagonal > 0 ? c.diagonal : 1;
  return {{"distance",
           {{"mean", both(to.mean, from.mean)},
            {"rms", both(to.rms, from.rms)},
            {"max", both(to.max, from.max)},
            {"bound", both(to.bound, from.bound)},
            {"mean_relative", both(to.mean / diagonal, from.mean / diagonal)},
            {"rms_relative", both(to.rms / diagonal, from.rms / diagonal)},
            {"max_relative", both(to.max / diagonal, from.max / diagonal)}}},
          {"normal_deviation", to_json(c.normal_deviation)},
          {"attributes", to_json(c.attributes)},
          {"diagonal", c.diagonal},
          {"samples", c.samples}};
}

Json to_json(const ImportReport& report) {
  return {{"format", report.format},
          {"normals", report.normals},
          {"up", to_json(report.up)},
          {"up_is_guessed", report.up_is_guessed},
          {"polygons", report.polygons},
          {"degenerate_triangles", report.degenerate_triangles},
          {"duplicate_triangles", report.duplicate_triangles},
          {"zero_area_triangles", report.zero_area_triangles},
          {"misoriented_edges", report.misoriented_edges},
          {"reversed_normals", report.reversed_normals},
          {"isolated_vertices", report.isolated_vertices},
          {"welded_vertices", report.welded_vertices},
          {"zero_normals", report.zero_normals},
          {"bad_attribute_values", report.bad_attribute_values},
          {"joined_normals", report.joined_normals},
          {"notes", report.notes}};
}

Json to_json(const ExportReport& report) {
  const Vec3d& origin = report.origin;
  return {{"origin", {origin.x, origin.y, origin.z}},
          {"rounding", report.rounding},
          {"left_out", report.left_out}};
}

std::vector<std::string> lines_of(const ExportReport& report, const std::filesystem::path& file) {
  std::vector<std::string> lines;
  if (!report.left_out.empty()) {
    std::string words = report.left_out[0];
    for (std::size_t i = 1; i < report.left_out.size(); ++i) {
      words += (i + 1 < report.left_out.size() ? ", " : " and ") + report.left_out[i];
    }
    lines.push_back(file.string() + ": leaves out " + words);
  }
  if (report.origin != Vec3d{}) {
    std::string line = file.string() + ": written less";
    for (int i = 0; i < 3; ++i) line += " " + in_all_digits(report.origin[i]);
    lines.push_back(line + ", as floats would lose too much so far from the origin");
  }
  return lines;
}

Json measured_json(const Comparison& c) {
  const Spread& to = c.distance.a_to_b;
  const Spread& from = c.distance.b_to_a;
  return {{"surface_mean", (to.mean + from.mean) / 2},
          {"surface_rms", std::max(to.rms, from.rms)},
          {"surface_max", hausdorff(c)},
          {"surface_bound", std::max(to.bound, from.bound)},
          {"degrees_mean", c.normal_deviation.mean},
          {"degrees_p95", c.normal_deviation.p95},
          {"degrees_max", c.normal_deviation.max},
          {"attributes", to_json(c.attributes)},
          {"samples", c.samples}};
}

std::string line_of(const AttributeDeviation& attribute) {
  const auto in_unit = [&](double value) {
    if (attribute.unit == DeviationUnit::Degrees) return in_degrees(value);
    char words[40];
    std::snprintf(words, sizeof words, "%.3g", value);
    return std::string(words);
  };
  const std::string& name = attribute.name;
  const std::string start = name + std::string(name.size() < 10 ? 11 - name.size() : 1, ' ');
  const DeviationSpread& spread = attribute.spread;
  if (attribute.unit == DeviationUnit::Share) {
    return start + "differs on " + in_unit(100 * spread.mean) + " %";
  }
  return start + "mean " + in_unit(spread.mean) + ", 95 % below " + in_unit(spread.p95) + ", max " +
         in_unit(spread.max);
}

std::string lines_of(const ImportReport& report) {
  std::string lines = "  " + report.format + "; normals: " + report.normals +
                      (report.up == UpAxis::Y ? "; y up" : "; z up") +
                      (report.up_is_guessed ? ", by its shape" : "");
  const auto say = [&lines](std::size_t count, const char* what) {
    if (count > 0) lines += "\n  " + grouped(count) + " " + what;
  };
  say(report.polygons, "polygons triangulated");
  say(report.degenerate_triangles, "triangles with two equal corners dropped");
  say(report.duplicate_triangles, "triangles repeat another's vertices: kept");
  say(report.zero_area_triangles, "triangles without area: kept");
  say(report.misoriented_edges, "edges join triangles of opposite orientation: kept");
  say(report.reversed_normals, "triangles have normals that point against their winding: kept");
  say(report.isolated_vertices, "isolated vertices dropped");
  say(report.welded_vertices, "stored vertices welded to one at the same place");
  say(report.zero_normals, "unusable normals replaced by the triangle's own");
  say(report.bad_attribute_values, "attribute values that are not finite set to zero");
  say(report.joined_normals, "normals joined with one that is almost the same");
  for (const std::string& note : report.notes) lines += "\n  " + note;
  return lines;
}

double hausdorff(const Comparison& c) {
  return std::max(c.distance.a_to_b.max, c.distance.b_to_a.max);
}

}  // namespace crease::cli
