#pragma once
// A bus that hears worse than the one behind it: the radio model of the simulator on top of a real network.

#include <functional>
#include <vector>

#include "link/bus.hpp"

namespace outrider::link {

/// Drops and delays what arrives, as the model says. Robots' models differ in their seeds only, so that breaks and splits
/// cut both directions of a link.
class ImpairedBus : public Bus {
 public:
  using Clock = std::function<double()>;  ///< [s] of the run
  ImpairedBus(Bus& inner, RobotId self, LinkModel model, Clock clock)
      : inner_(inner), self_(self), model_(std::move(model)), clock_(std::move(clock)) {}

  void send(Message message) override { inner_.send(std::move(message)); }
  std::vector<Delivery> receive() override;

 private:
  struct Late {
    double due_s;
    Delivery delivery;
  };
  Bus& inner_;
  RobotId self_;
  LinkModel model_;
  Clock clock_;
  std::vector<Late> late_;  // by arrival; delays are equal or the order changes as it would on the air
};

}  // namespace outrider::link
