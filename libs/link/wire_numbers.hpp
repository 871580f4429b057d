#pragma once
// Internal to the room: numbers of the wire, and what a number may be.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "world/robot.hpp"

namespace outrider::link {

inline constexpr double kFar = 1e7;  // [m]; nothing is farther away, larger or faster

inline std::int16_t i16(int value) { return static_cast<std::int16_t>(value); }
inline std::int16_t i16(std::size_t value) { return static_cast<std::int16_t>(value); }
inline std::int32_t i32(std::uint32_t value) { return std::bit_cast<std::int32_t>(value); }
inline std::uint32_t u32(std::int32_t value) { return std::bit_cast<std::uint32_t>(value); }

inline bool sane(double value) { return std::isfinite(value) && std::abs(value) <= kFar; }
inline bool size(double value) { return sane(value) && value >= 0.0; }
inline bool truth(std::int8_t value) { return value == 0 || value == 1; }
inline bool sane(const double (&pose)[3]) { return sane(pose[0]) && sane(pose[1]) && sane(pose[2]); }

template <class To, class From, class Convert>
std::vector<To> each(const std::vector<From>& from, Convert&& convert) {
  std::vector<To> to;
  to.reserve(from.size());
  for (const From& element : from) to.push_back(convert(element));
  return to;
}

template <class List, class Good>
bool all(const List& list, Good&& good) {
  return std::all_of(list.begin(), list.end(), good);
}

inline bool robots(const std::vector<std::int16_t>& list) {
  return all(list, [](std::int16_t robot) { return robot >= 0; });
}
inline std::vector<std::int16_t> robots(const std::vector<RobotId>& list) {
  return each<std::int16_t>(list, [](RobotId robot) { return i16(robot); });
}

}  // namespace outrider::link
