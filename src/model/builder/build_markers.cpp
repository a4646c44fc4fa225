// Markers.
#include "model/builder/build_parts.hpp"
#include "model/derived/connections.hpp"
#include "model/derived/frames.hpp"

namespace scree {

void build_markers(const DeckTable& deck, const Model& model, ModelNames& names) {
  for (const DeckTable& table : deck.tables("markers")) {
    const std::string& body = table.text("body");
    NamedMarker marker;
    if (body == kGroundName) {
      marker.bodies = {kGround};
    } else if (const auto single = names.bodies.find(body); single != names.bodies.end()) {
      marker.bodies = {single->second};
    } else {
      marker.bodies = find_row(names, body, table, "body", {kGroundName});
      marker.row = true;
    }
    const int first = marker.bodies.front();
    if (first != kGround && !is_spatial(model, first))
      table.fail("body", "must be spatial (bodies.kind) or \"ground\"");
    marker.marker = {from_center(model, first, table.vector("local_point")), read_orientation(table)};
    names.markers[table.text("name")] = std::move(marker);  // the reader refuses repeated names
  }
}

}  // namespace scree
