#pragma once
// report.html: one self-contained page that opens offline. The same record gives the same bytes: wall-clock figures
// stay out of it.

#include <string>
#include <string_view>

#include "report/run_record.hpp"

namespace outrider::report {

std::string report_html(const RunRecord& record);

/// The page of `outrider watch`: it draws what its server sends as events (docs/protocol.md).
std::string watch_html();

/// For text between tags and inside quoted attributes.
std::string escape_html(std::string_view text);

/// For <script type="application/json">: valid JSON in which no `</`, `<!--` or `]]>` can end the element.
std::string script_json(const Json& json);

/// One command line that a POSIX shell splits back into `argv`.
std::string shell_command(const std::vector<std::string>& argv);

/// Fills `{{name}}` in `page` by the values, in one pass (values are never searched again). Every placeholder must
/// have a value (assertion).
std::string fill_template(std::string_view page, const std::vector<std::pair<std::string, std::string>>& values);

}  // namespace outrider::report
