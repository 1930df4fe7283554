// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// When failure has cut through the wall around a hole, on grids drawn by hand.
#include "run/cut_through.hpp"

#include <string>

#include "catch.hpp"

using namespace vsb::app;

namespace {

/// Rows from top to bottom: '.' nothing, 'o' particles, '#' failed ones. The hole's axis is in the lower left
/// corner, where planes of symmetry meet; or in the middle.
bool cut_through(const std::vector<std::string>& rows, bool symmetric) {
  Scene scene;
  scene.dimension = 2;
  scene.grid.cells = {static_cast<int>(rows[0].size()), static_cast<int>(rows.size()), 0};
  scene.grid.spacing = {0.5, 0.25, 0};
  scene.grid.lower = {1, -2, 0};
  HoleSpec hole;
  hole.center = {1, -2, 0};
  if (symmetric)
    scene.faces.fixed[0][0] = scene.faces.fixed[1][0] = 1;
  else
    hole.center = {1 + 0.25 * scene.grid.cells[0], -2 + 0.125 * scene.grid.cells[1], 0};
  std::vector<CellContent> contents;
  for (auto row = rows.rbegin(); row != rows.rend(); ++row)
    for (const char c : *row)
      contents.push_back(c == '.'   ? CellContent::nothing
                         : c == '#' ? CellContent::marked
                                    : CellContent::particles);
  return hole_meets_outside(scene, hole, contents);
}

}  // namespace

TEST_CASE("a wall that failure has not cut through is whole") {
  CHECK_FALSE(cut_through({".......",  //
                           "oooo...",  //
                           "####o..",  //
                           "..##o..",  //
                           "...#o.."},
                          true));
  // Over an edge of cells there is no way.
  CHECK_FALSE(cut_through({".....",  //
                           "#o...",  //
                           "o#o..",  //
                           ".##o."},
                          true));
  // Failure at a plane of symmetry is not outside.
  CHECK_FALSE(cut_through({".....",  //
                           "oo...",  //
                           "##o..",  //
                           ".#o.."},
                          true));
}

TEST_CASE("a way of failed cells from the hole to the outside cuts the body") {
  CHECK(cut_through({"........",  //
                     "oooo....",  //
                     "####o...",  //
                     "..#####.",  //
                     "...#oo.."},
                    true));
  CHECK(cut_through({"........",  //
                     ".oooooo.",  //
                     ".oo..oo.",  //
                     ".oo..##.",  //
                     ".oooooo.",  //
                     "........"},
                    false));
  CHECK(cut_through({"........",  //
                     ".oooooo.",  //
                     ".oo..oo.",  //
                     ".o#..#o.",  //
                     ".##oooo.",  //
                     "........"},
                    false));
}

TEST_CASE("without a way from the axis nothing is cut through: a body whose hole is full") {
  CHECK_FALSE(cut_through({"......",  //
                           ".####.",  //
                           ".####.",  //
                           "......"},
                          false));
}
