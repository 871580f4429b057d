#pragma once
// Several runs side by side, as JSON and as a page. As text: figure_table (figures.hpp).

#include <span>
#include <string>

#include "report/run_folder.hpp"

namespace outrider::report {

/// {"runs": [{"run": name, "coordinator", "seed", ..., "result": {...}}]}: the results side by side.
Json comparison_json(std::span<const RunSummary> runs);

/// A self-contained page: the table of figures and the coverage curves on one chart.
std::string comparison_html(std::span<const RunSummary> runs);

}  // namespace outrider::report
