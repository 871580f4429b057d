#include "report/path_chart.hpp"

#include <fmt/format.h>

#include "report/html.hpp"

namespace outrider::report {
namespace {

constexpr double kWidth = 280.0, kTop = 22.0, kLine = 16.0;  // [px]
constexpr int kTones = 8;                                    // of the style sheet

}  // namespace

std::string path_chart(const std::string& title, Point low, Point high, std::span<const ChartPath> paths) {
  const double scale = kWidth / (high.x - low.x), height = scale * (high.y - low.y);
  const auto at = [&](Point p) {
    return fmt::format("{:.1f},{:.1f}", (p.x - low.x) * scale, kTop + height - (p.y - low.y) * scale);
  };
  std::string svg = fmt::format(
      "<svg viewBox=\"0 0 {:.0f} {:.0f}\" style=\"max-width: {:.0f}px; width: 100%; font: 11px var(--sans); fill: "
      "var(--ink)\" "
      "role=\"img\">\n<title>{}</title>\n<text x=\"0\" y=\"12\">{}</text>\n<rect x=\"0\" y=\"{:.0f}\" width=\"{:.0f}\" "
      "height=\"{:.1f}\" fill=\"none\" stroke=\"var(--rule)\"/>\n",
      kWidth, kTop + height + 1.5 * kLine, kWidth, escape_html(title), escape_html(title), kTop, kWidth, height);
  for (std::size_t k = 0; k < paths.size(); ++k) {
    const std::string tone = fmt::format("var(--tone-{})", k % kTones);
    std::string points;
    for (const Point& p : paths[k].points) points += (points.empty() ? "" : " ") + at(p);
    svg += fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.2\"/>\n", points, tone);
    if (!paths[k].points.empty()) {
      const Point p = paths[k].points.front();
      svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"/>\n", (p.x - low.x) * scale,
                         kTop + height - (p.y - low.y) * scale, tone);
    }
    svg += fmt::format("<text x=\"{:.0f}\" y=\"{:.1f}\" fill=\"{}\">{}</text>\n", 60.0 * static_cast<double>(k),
                       kTop + height + kLine, tone, escape_html(paths[k].label));
  }
  return svg + "</svg>\n";
}

}  // namespace outrider::report
