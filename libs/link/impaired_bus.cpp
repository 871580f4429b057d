#include "link/impaired_bus.hpp"

#include <algorithm>

namespace outrider::link {

std::vector<Delivery> ImpairedBus::receive() {
  const double now_s = clock_();
  for (Delivery& delivery : inner_.receive())
    if (const auto delay_s = model_(delivery.from, self_, now_s)) late_.push_back({now_s + *delay_s, std::move(delivery)});
  std::vector<Delivery> arrived;
  std::erase_if(late_, [&](Late& late) {
    if (late.due_s > now_s) return false;
    arrived.push_back(std::move(late.delivery));
    return true;
  });
  return arrived;
}

}  // namespace outrider::link
