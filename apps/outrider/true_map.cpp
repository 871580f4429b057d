#include "true_map.hpp"

#include <fmt/format.h>

namespace outrider::app {

std::string quality_lines(const report::Json& result) {
  if (!result.contains("map_quality")) return "";
  const report::Json& q = result["map_quality"];
  const report::Json& near = q["within_tolerance"];
  std::string text;
  if (q.contains("alignment")) {
    const report::Json& T = q["alignment"]["transform"];
    text = fmt::format("Map laid onto the true one at x {:.2f} m, y {:.2f} m, {:.1f} deg: fit {:.2f}, next best {:.2f}\n",
                       T[0].get<double>(), T[1].get<double>(), T[2].get<double>() * 180.0 / kPi,
                       q["alignment"]["score"].get<double>(), q["alignment"]["rival_score"].get<double>());
  }
  return text + fmt::format("Map quality: IoU {:.3f} of walls, {:.3f} of free space; accuracy {:.3f}; within {:.2f} m: "
                            "precision {:.3f}, recall {:.3f}; walls {:.3f} m off in the mean; {:.1f} % complete\n",
                            q["iou_occupied"].get<double>(), q["iou_free"].get<double>(), q["accuracy"].get<double>(),
                            near["tolerance_m"].get<double>(), near["precision"].get<double>(),
                            near["recall"].get<double>(), q["wall_to_truth_m"]["mean"].get<double>(),
                            100.0 * q["completeness"].get<double>());
}

}  // namespace outrider::app
