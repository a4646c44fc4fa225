// Keys of orientations, of the solids that bodies are made of, and of markers.
#include <fmt/format.h>

#include "deck/choices.hpp"
#include "deck/keys.hpp"

namespace scree {

std::vector<Key> orientation_keys(const std::string& prefix, const std::string& what,
                                  const std::string& outer) {
  const std::string otherwise = "another of these keys is given, or no rotation";
  const auto named = [&](const char* key) { return prefix + key; };
  return {
      reals(named("quaternion"), "")
          .entries(4)
          .left_out(otherwise)
          .about(fmt::format("Orientation of {}, scalar first: from components along its axes to those "
                             "along {}; of length 1 to 1e-6.",
                             what, outer)),
      vector(named("rotation_axis"), "")
          .left_out(otherwise)
          .about(fmt::format("The same as a rotation from {} about this axis, of any length but 0.", outer)),
      real(named("rotation_angle"), "rad")
          .left_out(fmt::format("no {}rotation_axis is given", prefix))
          .about("The angle of this rotation, right-handed."),
      vector(named("z_axis"), "")
          .left_out(otherwise)
          .about(fmt::format("The same by one or two directions in {}, of any length but 0: that of the z "
                             "axis.",
                             outer)),
      vector(named("x_axis"), "")
          .left_out(
              fmt::format("the direction across {}z_axis that is nearest to an axis of {}", prefix, outer))
          .about(fmt::format("That of the x axis, perpendicular to {0}z_axis: to 1e-6, then {0}z_axis is "
                             "kept.",
                             prefix))};
}

const TableKeys& solid_keys() {
  static constexpr auto round = {SolidKind::sphere, SolidKind::cylinder, SolidKind::capsule},
                        long_ones = {SolidKind::cylinder, SolidKind::capsule}, boxes = {SolidKind::box},
                        meshes = {SolidKind::mesh};
  static const TableKeys keys = [] {
    TableKeys solid{
        "Homogeneous solids that the body is made of, in place of its mass, centre of mass and inertia. They "
        "touch nothing; where two overlap, both count.",
        {choice<SolidKind>("kind").required().about("Sphere. Box: along x, y and z of its own frame. "
                                                    "Cylinder, capsule: along z; a capsule ends in two "
                                                    "half spheres. Mesh: one of the meshes."),
         text("mesh").only_for(meshes).required().about("Name of one of the meshes."),
         choice<MeshInertia>("inertia")
             .only_for(meshes)
             .otherwise_choice(MeshInertia::exact)
             .about("Exact: what the mesh encloses, if it is closed. Convex: what its convex hull encloses. "
                    "Shell: a skin on the mesh, closed or not."),
         real("thickness", "m")
             .only_for(meshes)
             .above(0)
             .left_out("inertia is not \"shell\"")
             .about("Of the skin, of which half lies on either side."),
         real("depth", "m").only_for(meshes).above(0).left_out("1 for a line").about("Of a line, along z."),
         real("radius", "m").only_for(round).above(0).required().about("Radius."),
         real("length", "m")
             .only_for(long_ones)
             .above(0)
             .required()
             .about("Length; of a capsule, without the half spheres."),
         reals("size", "m")
             .only_for(boxes)
             .entries(3)
             .above(0)
             .required()
             .about("Edges along x, y and z; in 2D, too."),
         vector("offset", "m").otherwise("zero").about("Its centre in the body's frame."),
         real("density", "kg/m^3").above(0).left_out("that of the material").about("Density."),
         text("material").left_out("the only material").about("Material that has the density.")},
        "kind"};
    for (const Key& key : orientation_keys("", "its own frame", "the body's frame"))
      solid.keys.push_back(key);
    return solid;
  }();
  return keys;
}

const TableKeys& marker_keys() {
  static const TableKeys keys = [] {
    TableKeys marker{
        "Points with axes, fixed to spatial bodies or the ground, that joints, force elements and applied "
        "forces refer to. The axis of a joint is z.",
        {name_key().required().about("Name for references."),
         text("body").required().about(
             "The body that it is fixed to, a row of bodies (a marker on each), or \"ground\"."),
         vector("local_point", "m")
             .otherwise("zero")
             .about("Its point in the body's frame; on the ground, in the global one.")},
        ""};
    for (const Key& key : orientation_keys("", "the marker", "the body's frame")) marker.keys.push_back(key);
    return marker;
  }();
  return keys;
}

}  // namespace scree
