#include "report/mission_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "report/html.hpp"

namespace outrider::report {
namespace {

// Colours that stay apart for colour-blind readers (Okabe and Ito), then again.
constexpr std::array<const char*, 7> kColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#999999"};
const char* colour(int i) { return i < 0 ? "#ffffff" : kColours[static_cast<std::size_t>(i) % kColours.size()]; }

struct Frame {
  double left = 1e300, bottom = 1e300, right = -1e300, top = -1e300;
  void add(Point p) {
    left = std::min(left, p.x), right = std::max(right, p.x);
    bottom = std::min(bottom, p.y), top = std::max(top, p.y);
  }
};

Frame frame_of(const MissionPicture& picture) {
  Frame f;
  for (const auto& place : picture.places) f.add(place.at);
  if (picture.map) {
    const auto& g = picture.map->geometry();
    f.add(g.origin);
    f.add({g.origin.x + g.width * g.resolution, g.origin.y + g.height * g.resolution});
  }
  for (const auto& way : picture.ways)
    for (const Point p : way) f.add(p);
  if (f.left > f.right) f.add({0.0, 0.0});
  return f;
}

/// Rows of cells that are not free, as one path; y is flipped.
std::string walls(const OccupancyGrid& map) {
  const auto& g = map.geometry();
  std::string d;
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width();) {
      int end = x;
      while (end < map.width() && map[Cell{end, y}] != CellState::kFree) ++end;
      if (end > x)
        d += fmt::format("M{:.2f} {:.2f}h{:.2f}v{:.2f}h{:.2f}z", g.origin.x + x * g.resolution,
                         -(g.origin.y + (y + 1) * g.resolution), (end - x) * g.resolution, g.resolution,
                         -(end - x) * g.resolution);
      x = std::max(end, x + 1);
    }
  return fmt::format("<path d=\"{}\" fill=\"#b8b8b8\"/>\n", d);
}

/// `shift` moves the line to its right, so that several on one way stay visible [m].
std::string line(const std::vector<Point>& way, double shift, const std::string& style) {
  std::string points;
  for (const Point p : way) points += fmt::format("{:.2f},{:.2f} ", p.x + shift, -p.y + shift);
  return fmt::format("<polyline points=\"{}\" fill=\"none\" {}/>\n", points, style);
}

}  // namespace

std::string mission_svg(const MissionPicture& picture) {
  const Frame f = frame_of(picture);
  const double span = std::max({f.right - f.left, f.top - f.bottom, 1e-6}), unit = span / 100.0, margin = 3.0 * unit;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"{:.2f} {:.2f} {:.2f} {:.2f}\" width=\"100%\" "
      "style=\"max-width:64rem;background:#fff\" font-family=\"sans-serif\">\n",
      f.left - margin, -f.top - margin, f.right - f.left + 2 * margin, f.top - f.bottom + 2 * margin);
  if (picture.map) svg += walls(*picture.map);
  for (const auto& way : picture.ways) svg += line(way, 0.0, fmt::format("stroke=\"#dddddd\" stroke-width=\"{:.3f}\"", 0.25 * unit));
  for (std::size_t i = 0; i < picture.tours.size(); ++i) {
    const double shift = (static_cast<double>(i) - 0.5 * static_cast<double>(picture.tours.size() - 1)) * 0.35 * unit;
    const char* paint = colour(static_cast<int>(i));
    svg += line(picture.tours[i].way, shift,
                fmt::format("stroke=\"{}\" stroke-width=\"{:.3f}\" stroke-opacity=\"{}\"", paint, 0.5 * unit,
                            picture.tours[i].driven.empty() ? "1" : "0.35"));
    if (!picture.tours[i].driven.empty())
      svg += line(picture.tours[i].driven, 0.0, fmt::format("stroke=\"{}\" stroke-width=\"{:.3f}\"", paint, 0.3 * unit));
    if (!picture.tours[i].way.empty()) {
      const Point p = picture.tours[i].way.front();
      svg += fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.3f}\" height=\"{:.3f}\" fill=\"{}\"><title>{} starts here"
                         "</title></rect>\n", p.x - unit, -p.y - unit, 2 * unit, 2 * unit, paint, escape_html(picture.tours[i].name));
    }
  }
  for (const MissionPlace& place : picture.places) {
    svg += fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:.3f}\" fill=\"{}\" stroke=\"#444\" stroke-width=\"{:.3f}\">"
                       "<title>{}</title></circle>\n", place.at.x, -place.at.y, (place.goal ? 1.2 : 0.45) * unit,
                       place.goal ? colour(place.owner) : "#888888", 0.12 * unit, escape_html(place.about));
    if (place.goal && place.order > 0)
      svg += fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\" font-size=\"{:.3f}\" text-anchor=\"middle\" fill=\"#fff\">{}</text>\n",
                         place.at.x, -place.at.y + 0.55 * unit, 1.6 * unit, place.order);
  }
  return svg + "</svg>\n";
}

std::string curve_svg(const std::vector<std::pair<double, double>>& points, const std::string& x_label,
                      const std::string& y_label) {
  if (points.size() < 2) return "";
  double x0 = points.front().first, x1 = x0, y0 = points.front().second, y1 = y0;
  for (const auto& [x, y] : points) x0 = std::min(x0, x), x1 = std::max(x1, x), y0 = std::min(y0, y), y1 = std::max(y1, y);
  const double width = 560.0, height = 160.0, dx = std::max(x1 - x0, 1e-12), dy = std::max(y1 - y0, 1e-12);
  std::string path;
  for (const auto& [x, y] : points)
    path += fmt::format("{:.1f},{:.1f} ", 70 + (x - x0) / dx * width, 10 + (1.0 - (y - y0) / dy) * height);
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 660 220\" width=\"100%\" style=\"max-width:44rem\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n<path d=\"M70 10V170H630\" fill=\"none\" stroke=\"#888\"/>\n"
      "<polyline points=\"{}\" fill=\"none\" stroke=\"#0072b2\" stroke-width=\"2\"/>\n"
      "<text x=\"66\" y=\"20\" text-anchor=\"end\">{:.4g}</text><text x=\"66\" y=\"170\" text-anchor=\"end\">{:.4g}</text>\n"
      "<text x=\"70\" y=\"186\">{:.4g}</text><text x=\"630\" y=\"186\" text-anchor=\"end\">{:.4g}</text>\n"
      "<text x=\"350\" y=\"206\" text-anchor=\"middle\">{}</text>"
      "<text x=\"14\" y=\"90\" text-anchor=\"middle\" transform=\"rotate(-90 14 90)\">{}</text>\n</svg>\n",
      path, y1, y0, x0, x1, escape_html(x_label), escape_html(y_label));
}

std::string mission_html(const std::string& title, const std::string& verdict, const MissionPicture& picture,
                         const std::string& curve, const std::vector<Table>& tables) {
  std::string page = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{0}</title>\n<style>body{{font-family:sans-serif;"
      "margin:2rem auto;max-width:68rem;padding:0 1rem;color:#222}}table{{border-collapse:collapse}}td,th{{padding:.2rem .7rem;"
      "text-align:right;border-bottom:1px solid #ddd}}td:first-child,th:first-child{{text-align:left}}figure{{margin:1.5rem 0}}"
      "figcaption{{font-weight:bold;margin-bottom:.4rem}}</style></head>\n<body>\n<h1>{0}</h1>\n<p>{1}</p>\n",
      escape_html(title), escape_html(verdict));
  page += "<p>";
  for (std::size_t i = 0; i < picture.tours.size(); ++i)
    page += fmt::format("<span style=\"color:{}\">&#9632;</span> {} &nbsp; ", colour(static_cast<int>(i)), escape_html(picture.tours[i].name));
  page += "squares: starts; numbered circles: goals in visiting order; small circles: waypoints</p>\n";
  page += mission_svg(picture);
  if (!curve.empty()) page += "<h2>How the allocation grew</h2>\n" + curve;
  for (const Table& table : tables) page += table_html(table);
  return page + "</body></html>\n";
}

}  // namespace outrider::report
