#include "cli/curves_svg.h"

#include "cli/text.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>

namespace crease::cli {

namespace {

// Of the drawing, in units of its viewBox.
constexpr double kWidth = 480, kHeight = 300;
constexpr double kSmallest = 1e-7;  // over the largest value: what is less is as good as none
constexpr double kLeft = 64, kRight = 34, kTop = 12, kBottom = 46;

std::string svg_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

// From the lowest to the highest value, a little more on both sides.
class LogScale {
 public:
  LogScale(double low, double high, double from, double to) : from_(from), to_(to) {
    low_ = std::log10(low);
    high_ = std::log10(high);
    const double margin = std::max(0.04 * (high_ - low_), 0.08);
    low_ -= margin;
    high_ += margin;
  }
  double at(double value) const {
    return from_ + (to_ - from_) * (std::log10(value) - low_) / (high_ - low_);
  }
  // Decades; where there are few, 3, or 2 and 5, between them; where there are many, not all.
  std::vector<double> ticks() const {
    const int first = static_cast<int>(std::floor(low_));
    const int last = static_cast<int>(std::ceil(high_));
    const double decades = high_ - low_;
    const int step = std::max(1, static_cast<int>(std::ceil(decades / 7)));
    std::vector<double> found;
    for (int e = first; e <= last; ++e) {
      if (e % step != 0) continue;
      for (const int digit : {1, 2, 3, 5}) {
        const bool is_shown =
            digit == 1 || (decades < 1.2 ? digit != 3 : decades < 2.6 && digit == 3);
        if (!is_shown) continue;
        const double value = digit * std::pow(10.0, e);
        if (std::log10(value) >= low_ && std::log10(value) <= high_) found.push_back(value);
      }
    }
    return found;
  }

 private:
  double low_, high_, from_, to_;
};

std::string tick_text(double value, const Axis& axis) {
  char text[32];
  if (axis.is_bytes) {
    const char* units[] = {" B", " kB", " MB", " GB", " TB"};
    std::size_t unit = 0;
    while (value >= 999.5 && unit + 1 < std::size(units)) value /= 1000, ++unit;
    std::snprintf(text, sizeof text, "%.4g%s", value, units[unit]);
    return text;
  }
  if (value >= 1000 && value < 1e9) return grouped(static_cast<std::uint64_t>(std::llround(value)));
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string axis_title(const Axis& axis) {
  return escaped(axis.name + (axis.unit.empty() ? "" : " [" + axis.unit + "]"));
}

std::string svg_text(double x, double y, const std::string& anchor, const std::string& content,
                     const std::string& more = "") {
  return "<text x=\"" + svg_number(x) + "\" y=\"" + svg_number(y) + "\" text-anchor=\"" + anchor +
         "\"" + more + ">" + content + "</text>\n";
}

std::string grid_svg(const Plot& plot, const LogScale& x, const LogScale& y) {
  const double right = kWidth - kRight, bottom = kHeight - kBottom;
  std::string svg;
  const auto line = [&](double x1, double y1, double x2, double y2, const char* kind) {
    svg += std::string("<line class=\"") + kind + "\" x1=\"" + svg_number(x1) + "\" y1=\"" +
           svg_number(y1) + "\" x2=\"" + svg_number(x2) + "\" y2=\"" + svg_number(y2) + "\"/>\n";
  };
  for (const double tick : x.ticks()) {
    line(x.at(tick), kTop, x.at(tick), bottom, "grid");
    svg += svg_text(x.at(tick), bottom + 15, "middle", tick_text(tick, plot.x));
  }
  for (const double tick : y.ticks()) {
    line(kLeft, y.at(tick), right, y.at(tick), "grid");
    svg += svg_text(kLeft - 6, y.at(tick) + 4, "end", tick_text(tick, plot.y));
  }
  line(kLeft, bottom, right, bottom, "axis");
  line(kLeft, kTop, kLeft, bottom, "axis");
  svg += svg_text((kLeft + right) / 2, kHeight - 8, "middle", axis_title(plot.x));
  svg +=
      svg_text(0, 0, "middle", axis_title(plot.y),
               " transform=\"translate(13 " + svg_number((kTop + bottom) / 2) + ") rotate(-90)\"");
  return svg;
}

std::string curve_svg(const Curve& curve, const LogScale& x, const LogScale& y, double lowest) {
  const std::string style = "curve" + std::to_string(curve.color);
  std::string line, marks;
  for (const auto& [px, py] : curve.points) {
    if (!(px > 0) || py < lowest) continue;
    line += (line.empty() ? "" : " ") + svg_number(x.at(px)) + "," + svg_number(y.at(py));
    marks += "<circle class=\"" + style + "\" cx=\"" + svg_number(x.at(px)) + "\" cy=\"" +
             svg_number(y.at(py)) + "\" r=\"3\"/>\n";
  }
  std::string svg = "<polyline class=\"" + style + (curve.is_dashed ? " dashed" : "") +
                    "\" points=\"" + line + "\"/>\n";
  return curve.is_dashed ? svg : svg + marks;
}

std::string legend_html(const Plot& plot) {
  std::string html = "<p class=\"legend\">";
  for (const Curve& curve : plot.curves) {
    html += "<span><svg viewBox=\"0 0 24 10\" width=\"24\" height=\"10\"><line class=\"curve" +
            std::to_string(curve.color) + (curve.is_dashed ? " dashed" : "") +
            "\" x1=\"0\" y1=\"5\" x2=\"24\" y2=\"5\"/></svg> " + escaped(curve.name) + "</span> ";
  }
  return html + "</p>\n";
}

}  // namespace

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        if (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') {
          out += "\xEF\xBF\xBD";
        } else {
          out += c;
        }
    }
  }
  return out;
}

std::string curves_svg(const Plot& plot) {
  std::string html =
      "<figure class=\"plot\"><figcaption>" + escaped(plot.title) + "</figcaption>\n";
  double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {0, 0};
  for (const Curve& curve : plot.curves) {
    for (const auto& [px, py] : curve.points) {
      if (px > 0) high[1] = std::max(high[1], py);
    }
  }
  if (high[1] == 0) return html + "<p>Nothing to plot: no level is off.</p></figure>\n";
  const double lowest = kSmallest * high[1];
  for (const Curve& curve : plot.curves) {
    for (const auto& [px, py] : curve.points) {
      if (!(px > 0) || py < lowest) continue;
      low[0] = std::min(low[0], px);
      high[0] = std::max(high[0], px);
      low[1] = std::min(low[1], py);
    }
  }
  const LogScale x(low[0], high[0], kLeft, kWidth - kRight);
  const LogScale y(low[1], high[1], kHeight - kBottom, kTop);
  html += "<svg viewBox=\"0 0 " + svg_number(kWidth) + " " + svg_number(kHeight) +
          "\" role=\"img\" aria-label=\"" + escaped(plot.title) + "\">\n" + grid_svg(plot, x, y);
  for (const Curve& curve : plot.curves) html += curve_svg(curve, x, y, lowest);
  return html + "</svg>\n" + legend_html(plot) + "</figure>\n";
}

}  // namespace crease::cli
