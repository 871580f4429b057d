#pragma once
// Internal to the room: one pair of conversions for each message and its generated LCM type. from_wire() gets a decoded
// struct of the right size and returns nothing when a value in it cannot be; headers are the codec's.

#include <optional>

#include "outrider_wire/awards_t.hpp"
#include "outrider_wire/bid_sheet_t.hpp"
#include "outrider_wire/claim_sheet_t.hpp"
#include "outrider_wire/introduction_t.hpp"
#include "outrider_wire/map_digest_t.hpp"
#include "outrider_wire/map_tile_t.hpp"
#include "outrider_wire/map_update_t.hpp"
#include "outrider_wire/plan_sheet_t.hpp"
#include "outrider_wire/round_open_t.hpp"
#include "outrider_wire/status_t.hpp"
#include "outrider_wire/task_answer_t.hpp"
#include "outrider_wire/task_offer_t.hpp"
#include "outrider_wire/tile_request_t.hpp"
#include "world/messages.hpp"

namespace outrider::link {

outrider_wire::status_t to_wire(const StatusMessage& m);
outrider_wire::map_update_t to_wire(const MapUpdate& m);
outrider_wire::map_digest_t to_wire(const MapDigest& m);
outrider_wire::tile_request_t to_wire(const TileRequest& m);
outrider_wire::map_tile_t to_wire(const MapTile& m);
outrider_wire::round_open_t to_wire(const RoundOpen& m);
outrider_wire::bid_sheet_t to_wire(const BidSheet& m);
outrider_wire::awards_t to_wire(const Awards& m);
outrider_wire::introduction_t to_wire(const Introduction& m);
outrider_wire::claim_sheet_t to_wire(const ClaimSheet& m);
outrider_wire::task_offer_t to_wire(const TaskOffer& m);
outrider_wire::task_answer_t to_wire(const TaskAnswer& m);
outrider_wire::plan_sheet_t to_wire(const PlanSheet& m);

std::optional<Message> from_wire(const outrider_wire::status_t& w, RobotId sender);
std::optional<Message> from_wire(const outrider_wire::map_update_t& w, RobotId sender);
std::optional<Message> from_wire(const outrider_wire::map_digest_t& w, RobotId sender);
std::optional<Message> from_wire(const outrider_wire::tile_request_t& w, RobotId sender);
std::optional<Message> from_wire(const outrider_wire::map_tile_t& w, RobotId sender);
std::optional<Message> from_wire(const outrider_wire::round_open_t& w, RobotId sender);
std::optional<Message> from_wire(const outrider_wire::bid_sheet_t& w, RobotId sender);
std::optional<Message> from_wire(const outrider_wire::awards_t& w, RobotId sender);
std::optional<Message> from_wire(const outrider_wire::introduction_t& w, RobotId sender);
std::optional<Message> from_wire(const outrider_wire::claim_sheet_t& w, RobotId sender);
std::optional<Message> from_wire(const outrider_wire::task_offer_t& w, RobotId sender);
std::optional<Message> from_wire(const outrider_wire::task_answer_t& w, RobotId sender);
std::optional<Message> from_wire(const outrider_wire::plan_sheet_t& w, RobotId sender);

}  // namespace outrider::link
