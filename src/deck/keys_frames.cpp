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
          .about(fmt::format("Orientation of {} as a quaternion, scalar first, that transforms components "
                             "along its axes to components along those of {}; of length 1 to 1e-6.",
                             what, outer)),
      vector(named("rotation_axis"), "")
          .left_out(otherwise)
          .about(fmt::format("The orientation as a rotation from {} about this axis, of any length but 0.",
                             outer)),
      real(named("rotation_angle"), "rad")
          .left_out(fmt::format("no {}rotation_axis is given", prefix))
          .about("The angle of this rotation, right-handed."),
      vector(named("z_axis"), "")
          .left_out(otherwise)
          .about(fmt::format(
              "The orientation by one or two directions in {}: the z axis, of any length but 0.", outer)),
      vector(named("x_axis"), "")
          .left_out(fmt::format("the direction perpendicular to {}z_axis that is nearest to an axis of {}",
                                prefix, outer))
          .about(fmt::format("The x axis, perpendicular to {0}z_axis to 1e-6; a smaller deviation is removed "
                             "by adjusting the x axis.",
                             prefix))};
}

const TableKeys& solid_keys() {
  static constexpr auto round = {SolidKind::sphere, SolidKind::cylinder, SolidKind::capsule},
                        long_ones = {SolidKind::cylinder, SolidKind::capsule}, boxes = {SolidKind::box},
                        meshes = {SolidKind::mesh};
  static const TableKeys keys = [] {
    TableKeys solid{
        "Homogeneous solids that define the body's mass, centre of mass and inertia, in place of those keys. "
        "They take no part in contact; overlapping solids both count.",
        {choice<SolidKind>("kind").required().about(
             "Sphere. Box: along x, y and z of its own frame. Cylinder, capsule: along z; a capsule ends in "
             "two hemispheres. Mesh: one of the meshes."),
         text("mesh").only_for(meshes).required().about("Name of one of the meshes."),
         choice<MeshInertia>("inertia")
             .only_for(meshes)
             .otherwise_choice(MeshInertia::exact)
             .about("Exact: the volume that a closed mesh encloses. Convex: the volume of its convex hull. "
                    "Shell: a thin shell on the mesh, closed or not."),
         real("thickness", "m")
             .only_for(meshes)
             .above(0)
             .left_out("inertia is not \"shell\"")
             .about("Thickness of the shell, half of it on either side."),
         real("depth", "m")
             .only_for(meshes)
             .above(0)
             .left_out("1 for a line")
             .about("Extent of a line mesh along z."),
         real("radius", "m").only_for(round).above(0).required().about("Radius."),
         real("length", "m")
             .only_for(long_ones)
             .above(0)
             .required()
             .about("Length; for a capsule, without the hemispheres."),
         reals("size", "m")
             .only_for(boxes)
             .entries(3)
             .above(0)
             .required()
             .about("Edge lengths along x, y and z; three of them in 2D, too."),
         vector("offset", "m").otherwise("zero").about("Centre of the solid in the body's frame."),
         real("density", "kg/m^3").above(0).left_out("that of the material").about("Density."),
         text("material").left_out("the only material").about("Material whose density is used.")},
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
        "forces refer to. The axis of a joint is the marker's z.",
        {name_key().required().about("Name for references."),
         text("body").required().about(
             "The body to which the marker is fixed, a row of bodies (a marker on each), or \"ground\"."),
         vector("local_point", "m")
             .otherwise("zero")
             .about("Its point in the body's frame; for the ground, in the global frame.")},
        ""};
    for (const Key& key : orientation_keys("", "the marker", "the body's frame")) marker.keys.push_back(key);
    return marker;
  }();
  return keys;
}

}  // namespace scree
