// Cells of a VTKHDF series whose points belong to one cell each: a vertex per point, or a line per two
// points. They change only with their number.
#pragma once

#include <cstdint>

#include "output/hdf5_file.hpp"
#include "output/shared_rows.hpp"

namespace scree {

struct SeriesCells {
  const char* group;    // name of the cells' group in the file
  const char* nothing;  // name of a group without cells
  int column;           // column of these cells in Steps/CellOffsets
  std::int64_t points;  // points per cell
};
inline constexpr SeriesCells kVertices{"Vertices", "Lines", 0, 1}, kLines{"Lines", "Vertices", 1, 2};

// Position of a part in the rows.
struct PartRows {
  std::int64_t part = 0, first_cell = 0;
};

// Creates the groups of all kinds of cells in a new file, which has NumberOfPoints.
void create_cells(Hdf5File& file, const SeriesCells& cells, const RowStorage& of_points,
                  std::int64_t parts_per_chunk);
// Adds space for one more part with so many points.
void add_cells(Hdf5File& file, const SeriesCells& cells, std::int64_t points);
// Removes the cells after a part.
void cut_cells(Hdf5File& file, const SeriesCells& cells, const PartRows& last, std::int64_t points);
// Writes the cells of this rank's points of the part; has_end: this is the last rank.
void write_cells(SharedRows& file, const SeriesCells& cells, const PartRows& place, RowPart points,
                 bool has_end);

}  // namespace scree
