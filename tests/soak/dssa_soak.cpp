// Thousands of auctions over a bad radio: dssa_soak [RUNS [FIRST_SEED]]. Not part of ctest.

#include <cstdlib>

#include "support/lossy_auctions.hpp"

int main(int argc, char** argv) {
  const unsigned long long runs = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 10000;
  const unsigned long long first = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  unsigned long long bad = 0, sent = 0;
  double longest_s = 0.0;
  for (const bool plans : {false, true})
    for (unsigned long long seed = first; seed < first + runs; ++seed) {
      const auto run = outrider::test::lossy_auction(seed, plans);
      sent += run.result.radio.sent;
      longest_s = std::max(longest_s, run.result.duration_s);
      if (run.wrong.empty()) continue;
      ++bad;
      fmt::print("{} seed {}: {}\n", plans ? "scout" : "dssa", seed, run.wrong);
    }
  fmt::print("{} auctions of each protocol, {} broke a law; {} messages, the longest took {:.1f} s simulated\n", runs, bad,
             sent, longest_s);
  return bad == 0 ? 0 : 1;
}
