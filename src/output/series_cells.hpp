// The cells of a VTKHDF series whose points are theirs alone: a vertex for each point, or a line for each
// two. They change where their number does.
#pragma once

#include <cstdint>

#include "output/hdf5_file.hpp"
#include "output/shared_rows.hpp"

namespace scree {

struct SeriesCells {
  const char* group;    // of theirs in the file
  const char* nothing;  // of a kind of which there are none
  int column;           // theirs in Steps/CellOffsets
  std::int64_t points;  // of each
};
inline constexpr SeriesCells kVertices{"Vertices", "Lines", 0, 1}, kLines{"Lines", "Vertices", 1, 2};

// Where a part has its rows.
struct PartPlace {
  std::int64_t part = 0, first_cell = 0;
};

// In a new file that has NumberOfPoints: the groups of all kinds of cells.
void create_cells(Hdf5File& file, const SeriesCells& cells, const RowStorage& of_points,
                  std::int64_t parts_per_chunk);
// Room for one more part, of so many points.
void add_cells(Hdf5File& file, const SeriesCells& cells, std::int64_t points);
// All behind a part.
void cut_cells(Hdf5File& file, const SeriesCells& cells, const PartPlace& last, std::int64_t points);
// This rank's, of its points in the part; has_end: it is the last rank.
void write_cells(SharedRows& file, const SeriesCells& cells, const PartPlace& place, RowPart points,
                 bool has_end);

}  // namespace scree
