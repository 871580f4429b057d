#pragma once
// What report.js draws from: layers, trajectories, curves and events in compact form.

#include <cstdint>
#include <span>
#include <string>

#include "report/run_record.hpp"

namespace outrider::report {

/// gzip (fixed header: no time stamp), then base64. Deterministic.
std::string packed(std::span<const std::uint8_t> bytes);

/// Base64 of RFC 4648 with padding.
std::string base64(std::span<const std::uint8_t> bytes);

/// The data section of report.html. Time 0 is the earliest stamp of any trajectory, so that logs with absolute time
/// stamps play too (times of the timeline may be on either clock). Trajectories are thinned to about 60,000 points in
/// all, the timeline to 1,000 rows, and of the events the first 20,000 or 16 MB are kept: run folders hold the whole.
Json page_data(const RunRecord& record, const Json& result);

}  // namespace outrider::report
