#include "link/ether.hpp"

#include <algorithm>

#include "link/codec.hpp"

namespace outrider::link {

struct Ether::Endpoint : Bus {
  Endpoint(Ether& ether, RobotId robot) : ether_(ether), robot_(robot) {}

  void send(Message message) override { ether_.send_from(robot_, std::move(message)); }

  std::vector<Delivery> receive() override {
    const auto later = std::find_if(inbox_.begin(), inbox_.end(),
                                    [&](const InFlight& m) { return m.arrival_s > ether_.now_s_; });
    std::vector<Delivery> arrived;
    for (auto it = inbox_.begin(); it != later; ++it) arrived.push_back(std::move(it->delivery));
    inbox_.erase(inbox_.begin(), later);
    ether_.counters_.delivered += arrived.size();
    return arrived;
  }

  Ether& ether_;
  RobotId robot_;
  std::vector<InFlight> inbox_;  // sorted by (arrival, order)
};

Ether::Ether(int robots, LinkModel model) : model_(std::move(model)) {
  for (RobotId r = 0; r < robots; ++r) endpoints_.push_back(std::make_unique<Endpoint>(*this, r));
}

Ether::~Ether() = default;

Bus& Ether::endpoint(RobotId robot) { return *endpoints_[static_cast<std::size_t>(robot)]; }

bool Ether::pending() const {
  return std::any_of(endpoints_.begin(), endpoints_.end(), [&](const auto& e) {
    return !e->inbox_.empty() && e->inbox_.front().arrival_s <= now_s_;
  });
}

void Ether::send_from(RobotId from, Message message) {
  ++counters_.sent;
  counters_.bytes += encoded_size(message);
  const auto shared = std::make_shared<const Message>(std::move(message));
  for (auto& endpoint : endpoints_) {
    if (endpoint->robot_ == from) continue;
    const auto delay = model_(from, endpoint->robot_, now_s_);
    if (!delay) continue;
    InFlight m{now_s_ + *delay, order_++, {from, shared}};
    const auto at = std::upper_bound(endpoint->inbox_.begin(), endpoint->inbox_.end(), m,
                                     [](const InFlight& a, const InFlight& b) { return a.arrival_s < b.arrival_s; });
    endpoint->inbox_.insert(at, std::move(m));
  }
}

}  // namespace outrider::link
