#include "auction/bid_options.hpp"

#include <gtest/gtest.h>

#include "world/error.hpp"

namespace outrider::auction {
namespace {

TEST(BidOptions, SetWhatTheyName) {
  BidParameters k;
  set_bid_options(k, "rho=0.2,gain=footprint,turn=robot-order,sight=no");
  EXPECT_EQ(k.rho, 0.2);
  EXPECT_EQ(k.gain, Gain::kFootprint);
  EXPECT_EQ(k.turn, Turn::kRobotOrder);
  EXPECT_FALSE(k.sight);
  EXPECT_EQ(bid_options_text(k), "rho=0.2,gain=footprint,sight=no,turn=robot-order");
}

TEST(BidOptions, TextOfEveryOptionReadsBack) {
  for (const BidOptionInfo& info : bid_options()) {
    SCOPED_TRACE(info.key);
    const bool number = info.values.starts_with("number");
    const std::string text = info.key + "=" + (number ? "7.5" : info.values.substr(info.values.find('|') + 1));
    BidParameters k;
    EXPECT_EQ(bid_options_text(k), "");
    set_bid_options(k, text);
    EXPECT_EQ(bid_options_text(k), text);
  }
}

TEST(BidOptions, RefuseWhatTheyDoNotKnow) {
  BidParameters k;
  for (const char* text : {"roh=1", "rho", "rho=", "rho=1x", "rho=-1", "rho=nan", "gain=all", "=1"})
    EXPECT_THROW(set_bid_options(k, text), InputError) << text;
}

}  // namespace
}  // namespace outrider::auction
