#include "slam_glue/map_alignment.hpp"
#include "true_map.hpp"

namespace outrider::app {

void set_truth(OccupancyGrid truth, report::RunRecord& record) {
  if (const auto alignment = slam_glue::align_map(record.map, truth)) {
    const Pose2& T = alignment->T_truth_map;
    record.T_truth_map = T;
    record.alignment = {{"transform", {T.x, T.y, T.theta}}, {"score", alignment->score},
                        {"rival_score", alignment->rival}, {"moved", alignment->found}};
  }
  record.truth = std::move(truth);
}

}  // namespace outrider::app
