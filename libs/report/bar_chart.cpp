#include "report/bar_chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/html.hpp"

namespace outrider::report {
namespace {

constexpr double kLeft = 46.0, kTop = 28.0, kHeight = 190.0, kStep = 92.0, kBar = 48.0, kLine = 14.0;  // [px]
constexpr int kTones = 8;  // of the style sheet

/// 1, 2 or 5 times a power of ten, so that about five of them make `most`.
double tick_of(double most) {
  const double power = std::pow(10.0, std::floor(std::log10(most / 5.0)));
  const double rest = most / 5.0 / power;
  return power * (rest <= 1.0 ? 1.0 : rest <= 2.0 ? 2.0 : rest <= 5.0 ? 5.0 : 10.0);
}

std::string text(double x, double y, const char* anchor, const std::string& content) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor, escape_html(content));
}

std::string line(double x0, double y0, double x1, double y1, const char* colour) {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"var(--{})\"/>\n", x0, y0, x1,
                     y1, colour);
}

std::string label(double x, double y, const std::string& content) {
  std::string svg;
  for (std::size_t begin = 0; begin < content.size(); y += kLine) {
    const std::size_t end = std::min(content.find('+', begin), content.size() - 1) + 1;
    svg += text(x, y, "middle", content.substr(begin, end - begin));
    begin = end;
  }
  return svg;
}

}  // namespace

std::string bar_chart(const std::string& title, std::span<const Bar> bars) {
  double most = 0.0;
  for (const Bar& bar : bars)
    for (const double v : {bar.value, bar.interval.hi})
      if (std::isfinite(v)) most = std::max(most, v);
  if (most <= 0.0) most = 1.0;
  const double tick = tick_of(most), top = tick * std::ceil(most / tick);
  const auto y_of = [&](double v) { return kTop + kHeight * (1.0 - std::clamp(v / top, 0.0, 1.0)); };
  const double width = kLeft + kStep * static_cast<double>(bars.size());

  std::string svg = fmt::format(
      "<svg viewBox=\"0 0 {:.0f} {:.0f}\" style=\"max-width: {:.0f}px; width: 100%; font: 11px var(--sans); fill: var(--ink)\" "
      "role=\"img\">\n<title>{}</title>\n", width, kTop + kHeight + 3.2 * kLine, width, escape_html(title));
  svg += text(0.0, 12.0, "start", title);
  for (int k = 0; k * tick <= top * 1.0001; ++k) {
    svg += line(kLeft, y_of(k * tick), width, y_of(k * tick), "rule");
    svg += text(kLeft - 6.0, y_of(k * tick) + 4.0, "end", fmt::format("{:g}", k * tick));
  }
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const Bar& bar = bars[i];
    const double x = kLeft + kStep * (static_cast<double>(i) + 0.5);
    if (std::isfinite(bar.value))
      svg += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"var(--tone-{})\"/>\n",
                         x - kBar / 2.0, y_of(bar.value), kBar, kTop + kHeight - y_of(bar.value), i % kTones);
    if (std::isfinite(bar.interval.lo) && std::isfinite(bar.interval.hi)) {
      svg += line(x, y_of(bar.interval.lo), x, y_of(bar.interval.hi), "ink");
      for (const double v : {bar.interval.lo, bar.interval.hi}) svg += line(x - 6.0, y_of(v), x + 6.0, y_of(v), "ink");
    }
    svg += label(x, kTop + kHeight + kLine, bar.label);
  }
  return svg + "</svg>\n";
}

}  // namespace outrider::report
