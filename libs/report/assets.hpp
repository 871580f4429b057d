#pragma once
// The files that a page is made of, compiled in (libs/report/assets.cmake).

#include <string_view>

namespace outrider::report {

std::string_view report_template();      ///< assets/report.html
std::string_view watch_template();       ///< assets/watch.html
std::string_view watch_script();         ///< assets/watch.js
std::string_view comparison_template();  ///< assets/comparison.html
std::string_view style_sheet();          ///< assets/page.css
std::string_view report_script();        ///< assets/report.js
std::string_view map_script();           ///< assets/map_view.js
std::string_view comparison_script();    ///< assets/comparison.js
std::string_view chart_script();         ///< assets/charts.js: what both pages share
std::string_view chart_library();        ///< Debian's chart.min.js (package libjs-chart.js)

}  // namespace outrider::report
