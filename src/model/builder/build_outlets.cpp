// Outlets: regions in which particles are removed.
#include <fmt/format.h>

#include "base/mat3.hpp"
#include "model/builder/build_parts.hpp"
#include "model/builder/carriers.hpp"
#include "model/derived/frames.hpp"

namespace scree {

namespace {

constexpr Vec3 kEverywhere{kInfinity, kInfinity, kInfinity};

void set_frame(OutletRegion& region, Vec3 origin, const Mat3& frame) {
  region.origin = origin, region.x = frame.x, region.y = frame.y, region.z = frame.z;
}

OutletRegion region_of(const DeckTable& table, int dimension) {
  OutletRegion region;
  set_frame(region, {}, identity3());
  region.min = -kEverywhere, region.max = kEverywhere;
  switch (table.choice<OutletKind>("kind")) {
    case OutletKind::box: {
      const Vec3 low = table.vector("min"), high = table.vector("max"), extent = high - low;
      if (!(extent.x > 0 && extent.y > 0 && (dimension == 2 || extent.z > 0)))
        table.fail("max", "must be larger than min in every component");
      region.min = low, region.max = high;
      break;
    }
    case OutletKind::cylinder: {
      if (dimension == 2) table.fail("kind", "a cylinder needs 3D; a circle is kind = \"sphere\"");
      const Vec3 from = table.vectors("ends")[0], along = table.vectors("ends")[1] - from;
      if (!(norm(along) > 0)) table.fail("ends", "must not coincide");
      region.shape = OutletShape::cylinder, region.radius = table.real("region_radius");
      set_frame(region, from, frame_about((1 / norm(along)) * along));
      region.min.z = 0, region.max.z = norm(along);
      break;
    }
    case OutletKind::sphere:
      region.shape = OutletShape::sphere, region.radius = table.real("region_radius");
      region.origin = table.vector("center");
      break;
    case OutletKind::plane:
      set_frame(region, table.vector("point"), frame_about(read_direction(table, "normal")));
      region.min.z = 0;
      break;
  }
  return region;
}

}  // namespace

void build_outlets(const DeckTable& deck, Model& model, const ModelNames& names) {
  for (const DeckTable& table : deck.tables("outlets")) {
    if (std::ssize(model.outlets) == kMostOutlets)
      table.fail("name", fmt::format("a deck can have at most {} outlets", kMostOutlets));
    Outlet outlet;
    outlet.name = table.text("name");
    for (const Outlet& other : model.outlets)
      if (other.name == outlet.name) table.fail("name", "is the name of another outlet");
    outlet.region = region_of(table, model.space.dimension);
    outlet.carrier = carrier_of(table, model, names);
    outlet.start = table.real("start");
    if (table.has("end")) outlet.end = table.real("end");
    if (!(outlet.end > outlet.start))
      table.fail("end", fmt::format("must be above start = {} s", outlet.start));
    const Real interval = table.has("interval")
                              ? table.real("interval")
                              : fall_interval(table, model, model.particles.totals.smallest_radius);
    outlet.interval = checked_interval(table, model, interval);
    model.outlets.push_back(std::move(outlet));
  }
}

}  // namespace scree
