#include "output/xdmf.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace scree {

namespace {

// A dataset below /VTKHDF, with its width and value type in the terms of XDMF.
struct XdmfArray {
  std::string dataset;
  int width;
  const char* type;
  int bytes;
};

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

// Rows [first, first + count) of a dataset. XDMF 2 readers use the two inner items (the selection and the
// data), XDMF 3 readers the text of the outer item, "file:dataset|start:stride:count:shape"; each ignores the
// other form.
std::string slab(const XdmfSeries& series, const XdmfArray& array, std::int64_t first, std::int64_t count) {
  const bool vector = array.width > 1;
  const std::string width = vector ? fmt::format(" {}", array.width) : "";
  const std::string zero = vector ? " 0" : "", one = vector ? " 1" : "";
  const std::string source = fmt::format("{}:/VTKHDF/{}", escaped(series.data_file), escaped(array.dataset));
  const std::string type =
      fmt::format("NumberType=\"{}\" Precision=\"{}\" Format=\"HDF\"", array.type, array.bytes);
  const std::int64_t end = first + count;
  return fmt::format(
      "<DataItem Type=\"HyperSlab\" Dimensions=\"{1}{2}\" {6}>{5}|{0}{3}:1{4}:{1}{2}:{7}{2}"
      "<DataItem Dimensions=\"3 {8}\" NumberType=\"Int\" Format=\"XML\">{0}{3} 1{4} {1}{2}</DataItem>"
      "<DataItem Dimensions=\"{7}{2}\" {6}>{5}</DataItem></DataItem>",
      first, count, width, zero, one, source, type, end, vector ? 2 : 1);
}

XdmfArray field_array(const std::string& group, const PointField& field) {
  XdmfArray array{group + field.name, field.width, "Float", 8};
  if (std::holds_alternative<const int*>(field.values)) array.type = "Int", array.bytes = 4;
  if (std::holds_alternative<const GlobalId*>(field.values)) array.type = "Int", array.bytes = 8;
  return array;
}

const char* attribute_type(int width) {
  return width == 9 ? "Tensor" : width == 3 ? "Vector" : width == 1 ? "Scalar" : "Matrix";
}

std::string vertices(const XdmfSeries& series, const SnapshotRows& place) {
  return fmt::format(
      "<Topology TopologyType=\"Polyvertex\" NumberOfElements=\"{}\" NodesPerElement=\"1\">{}</Topology>\n",
      place.points, slab(series, {"Vertices/Connectivity", 1, "Int", 8}, place.first_cell, place.points));
}

std::string lines(const XdmfSeries& series, const SnapshotRows& place) {
  return fmt::format(
      "<Topology TopologyType=\"Polyline\" NumberOfElements=\"{}\" NodesPerElement=\"2\">{}</Topology>\n",
      place.points / 2,
      slab(series, {"Lines/Connectivity", 1, "Int", 8}, 2 * place.first_cell, place.points));
}

std::string triangles(const XdmfSeries& series) {
  const std::int64_t count = series.triangles->count();
  return fmt::format("<Topology TopologyType=\"Triangle\" NumberOfElements=\"{}\">{}</Topology>\n", count,
                     slab(series, {"Polygons/Connectivity", 1, "Int", 8}, 0, 3 * count));
}

// Whether the fields belong to cells.
bool of_cells(const XdmfSeries& series) { return series.triangles != nullptr || series.lines; }

// A field with `count` values from row `first` on.
std::string attribute(const XdmfSeries& series, const std::string& name, const XdmfArray& array,
                      std::int64_t first, std::int64_t count) {
  return fmt::format("<Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"{}\">{}</Attribute>\n",
                     escaped(name), attribute_type(array.width), of_cells(series) ? "Cell" : "Node",
                     slab(series, array, first, count));
}

}  // namespace

std::string xdmf_grid(const XdmfSeries& series, const SnapshotRows& place) {
  if (place.points == 0) return {};
  std::string text = fmt::format("<Grid Name=\"{}\"><Time Value=\"{}\"/>\n", series.name, place.time);
  text += series.triangles ? triangles(series)
          : series.lines   ? lines(series, place)
                           : vertices(series, place);
  text += fmt::format("<Geometry GeometryType=\"XYZ\">{}</Geometry>\n",
                      slab(series, {"Points", 3, "Float", 8}, place.first_point, place.points));
  const std::int64_t points = series.lines ? 2 : 1;  // per row of a field
  const std::int64_t count = series.triangles ? series.triangles->count() : place.points / points;
  const std::int64_t first = series.triangles ? place.number * count : place.first_point / points;
  for (const PointField& field : *series.fields) {
    const bool constant = std::ranges::find(series.constant, field.name) != series.constant.end();
    text += attribute(series, field.name, field_array(of_cells(series) ? "CellData/" : "PointData/", field),
                      constant ? place.first_cell : first, count);
  }
  if (series.triangles)
    for (const TriangleNumbers& numbers : series.triangles->numbers)
      text += attribute(series, numbers.name, {"CellData/" + numbers.name, 1, "Int", 4}, 0, count);
  return text + "</Grid>\n";
}

std::string xdmf_document(const std::string& name, const std::string& title, const std::string& grids) {
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<Xdmf Version=\"3.0\">\n<Domain>\n"
      "<Information Name=\"title\" Value=\"{}\"/>\n"
      "<Grid Name=\"{}\" GridType=\"Collection\" "
      "CollectionType=\"Temporal\">\n{}</Grid>\n</Domain>\n</Xdmf>\n",
      escaped(title), escaped(name), grids);
}

}  // namespace scree
