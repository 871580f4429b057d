#include "world/grid.hpp"

#include <gtest/gtest.h>

#include "support/ascii.hpp"

namespace outrider {
namespace {

TEST(GridGeometry, CellsAndCenters) {
  const GridGeometry g{0.05, {-1.0, 2.0}, 7, 5};
  EXPECT_EQ(g.size(), 35U);
  for (std::size_t i = 0; i < g.size(); ++i) {
    EXPECT_EQ(g.index(g.cell_at(i)), i);
    EXPECT_EQ(g.cell_of(g.center(g.cell_at(i))), g.cell_at(i));
  }
  EXPECT_EQ(g.cell_at(8), (Cell{1, 1}));
  EXPECT_NEAR(g.center({0, 0}).x, -0.975, 1e-12);
  EXPECT_NEAR(g.center({0, 0}).y, 2.025, 1e-12);
  EXPECT_DOUBLE_EQ(g.cell_area(), 0.0025);
}

TEST(GridGeometry, LeftOfTheOriginIsNotCellZero) {
  const GridGeometry g{1.0, {}, 3, 3};
  EXPECT_EQ(g.cell_of({-0.5, -0.001}), (Cell{-1, -1}));
  EXPECT_EQ(g.cell_of({0.0, 0.0}), (Cell{0, 0}));
  EXPECT_FALSE(g.contains(g.cell_of({-0.5, 0.5})));
  EXPECT_FALSE(g.contains(g.cell_of({3.0, 0.5})));  // the far edge belongs to the next cell
  EXPECT_TRUE(g.contains(g.cell_of({2.999, 2.999})));
}

TEST(Ascii, DrawsWhatItReads) {
  const auto* text = R"(
    ?a#
    .#b)";
  const OccupancyGrid map = test::grid_from_ascii(text, 0.5);
  EXPECT_EQ(map.geometry(), (GridGeometry{0.5, {}, 3, 2}));
  EXPECT_EQ((map[Cell{0, 1}]), CellState::kUnknown);
  EXPECT_EQ((map[Cell{1, 0}]), CellState::kOccupied);
  EXPECT_EQ(test::cell_marked(text, 'a'), (Cell{1, 1}));
  EXPECT_EQ(test::to_ascii(map), "?.#\n.#.\n");
  EXPECT_EQ(test::to_ascii(map, {{'a', {1, 1}}, {'b', {2, 0}}}), test::tidy_ascii(text));
  EXPECT_THROW(test::grid_from_ascii("..\n."), std::invalid_argument);
  EXPECT_THROW(test::cell_marked("aa", 'a'), std::invalid_argument);
}

}  // namespace
}  // namespace outrider
