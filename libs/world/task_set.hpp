#pragma once
// A set of tasks, numbered from 0; small, hashable, a value.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace outrider {

/// Up to kMost tasks as bits.
class TaskSet {
 public:
  static constexpr int kMost = 256;

  TaskSet() = default;
  /// The tasks whose bits are set in `low`; tasks 0 to 63 only.
  explicit TaskSet(std::uint64_t low) { words_[0] = low; }
  /// {0, ..., n - 1}.
  static TaskSet first(int n) {
    TaskSet set;
    for (int task = 0; task < n; ++task) set.insert(task);
    return set;
  }

  bool contains(int task) const { return (words_[word(task)] >> bit(task) & 1U) != 0; }
  void insert(int task) { words_[word(task)] |= std::uint64_t{1} << bit(task); }
  void erase(int task) { words_[word(task)] &= ~(std::uint64_t{1} << bit(task)); }
  TaskSet with(int task) const {
    TaskSet set = *this;
    set.insert(task);
    return set;
  }
  TaskSet without(int task) const {
    TaskSet set = *this;
    set.erase(task);
    return set;
  }

  int size() const {
    int n = 0;
    for (const std::uint64_t w : words_) n += std::popcount(w);
    return n;
  }
  bool empty() const { return *this == TaskSet{}; }
  std::uint64_t low() const { return words_[0]; }  ///< tasks 0 to 63 as bits

  /// Calls visit(task) for each member, ascending.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (std::size_t w = 0; w < words_.size(); ++w)
      for (std::uint64_t rest = words_[w]; rest != 0; rest &= rest - 1)
        visit(static_cast<int>(64 * w) + std::countr_zero(rest));
  }
  std::vector<int> members() const {
    std::vector<int> tasks;
    for_each([&](int task) { tasks.push_back(task); });
    return tasks;
  }

  friend bool operator==(const TaskSet&, const TaskSet&) = default;
  friend auto operator<=>(const TaskSet&, const TaskSet&) = default;

  struct Hash {
    std::size_t operator()(const TaskSet& set) const {
      std::uint64_t h = 0x9e3779b97f4a7c15ULL;
      for (const std::uint64_t w : set.words_) {
        h = (h ^ w) * 0xbf58476d1ce4e5b9ULL;
        h ^= h >> 31;
      }
      return static_cast<std::size_t>(h);
    }
  };

 private:
  static std::size_t word(int task) { return static_cast<std::size_t>(task) / 64; }
  static int bit(int task) { return task % 64; }
  std::array<std::uint64_t, kMost / 64> words_{};
};

}  // namespace outrider
