// Keys of particles.
#include "deck/choices.hpp"
#include "deck/keys.hpp"

namespace scree {

const TableKeys& particle_keys() {
  using Kind = GroupKind;
  static constexpr auto spaced = {Kind::row, Kind::lattice};
  static const TableKeys keys{
      "Groups of particles; their indices continue from group to group in the deck's order.",
      {name_key().left_out("none").about("Name for messages and for --set particles.NAME.key=value."),
       choice<Kind>("kind").required().about(
           "List: given positions. Row: equally spaced. Lattice: layer by layer, row by row. Random: random "
           "positions in a region, the part of the domain that is inside everything that is given of a box "
           "(min, max), a cylinder, a mesh and a body. Random particles overlap neither each other nor "
           "earlier groups, nor walls, nor the shapes and meshes of bodies and walls. File: read from a "
           "file."),
       vectors("positions", "m").only_for({Kind::list}).required().about("Centres."),
       vector("origin", "m")
           .only_for(spaced)
           .left_out("center is given")
           .about("Centre of the first particle."),
       vector("center", "m")
           .only_for({Kind::lattice, Kind::random})
           .left_out("origin is given; random: cylinder_radius is left out, or the domain is 3D")
           .about("Centre of the whole lattice, also if count leaves some of its sites empty; in 2D also of "
                  "the circle that a random group fills."),
       vector("spacing", "m")
           .only_for(spaced)
           .required()
           .about("Row: vector from each particle to the next. Lattice: distance along each axis."),
       integers("size")
           .only_for({Kind::lattice})
           .at_least(1)
           .required()
           .about("Number of lattice sites along each axis; filled along x first, then y, then z."),
       integer("count")
           .only_for({Kind::row, Kind::lattice, Kind::random})
           .within(1, 1000000000)
           .left_out("lattice: all its sites")
           .about("Number of particles; a lattice fills its first count sites."),
       vector("min", "m")
           .only_for({Kind::random})
           .left_out("another region is given")
           .about("Lower corner of the box that contains the particles."),
       vector("max", "m")
           .only_for({Kind::random})
           .left_out("another region is given")
           .about("Upper corner of the box."),
       real("cylinder_radius", "m")
           .only_for({Kind::random})
           .above(0)
           .left_out("no cylinder")
           .about("Radius of a cylinder that contains the particles, between its ends; in 2D of a circle "
                  "about center."),
       vectors("ends", "m")
           .only_for({Kind::random})
           .entries(2)
           .left_out("no cylinder, or the domain is 2D")
           .about("The two ends of the cylinder's axis."),
       text("mesh")
           .only_for({Kind::random})
           .left_out("no mesh")
           .about("A closed mesh whose inside contains the particles, in its pose on the wall or the body "
                  "that has it, otherwise in the global frame. It must be an open surface (a file with sheet "
                  "= true) or not collide: the inside of other meshes is solid."),
       text("body")
           .only_for({Kind::random})
           .left_out("no body; with a mesh, the only one that has it")
           .about("A body whose inside contains the particles: the part of the convex hull of its shapes and "
                  "meshes that is not solid, as in a bucket filled to its brim. With mesh: the body that has "
                  "this mesh."),
       real("gap", "m")
           .only_for({Kind::random})
           .at_least(0)
           .otherwise("0.0")
           .about("Smallest distance between the surfaces of two particles."),
       integer("tries")
           .only_for({Kind::random})
           .within(1, 1000000000)
           .otherwise("10000")
           .about("Number of random positions in the region that are tried for one particle before the deck "
                  "is refused."),
       file("file")
           .only_for({Kind::file})
           .required()
           .about("CSV with a header line, or HDF5 (.h5, .hdf5) with one dataset per column: x, y, z (3D) "
                  "[m]; optional vx, vy, vz [m/s], wx, wy, wz [rad/s] (in 2D wz), radius [m], mass [kg], "
                  "inertia_factor."),
       quantity("radius", "m", distribution_keys())
           .left_out("the file has a column radius")
           .about("Radius, or a distribution from which it is drawn."),
       quantity("mass", "kg", distribution_keys())
           .left_out("the file's column mass, or from density")
           .about("Mass, or a distribution."),
       quantity("density", "kg/m^3", distribution_keys())
           .left_out("the material's density")
           .about("Density, or a distribution; gives the mass of a sphere (3D), or of a disc of the given "
                  "thickness (2D)."),
       real("thickness", "m").above(0).otherwise("1.0").about("2D: thickness of the discs, for density."),
       real("inertia_factor", "")
           .above(0)
           .within(0, 1)
           .left_out("the file's column inertia_factor, or 2/5 (3D) and 1/2 (2D), solid spheres and discs")
           .about("Moment of inertia about the centre over m r^2, where particles rotate: 2/3 for a hollow "
                  "sphere, 1 for a thin ring (2D)."),
       text("material").left_out("the only material").about("Material."),
       vector("velocity", "m/s").otherwise("zero").about("Velocity at t = 0, added to that of a file."),
       reals("angular_velocity", "rad/s")
           .otherwise("[]")
           .about("Angular velocity at t = 0, added to that of a file, where particles rotate: a pair of "
                  "materials has friction. Three numbers; in 2D one, about z. Empty: zero."),
       real("random_velocity", "m/s")
           .at_least(0)
           .otherwise("0.0")
           .about("Half-width of the uniform distribution of a random part that is added to each velocity "
                  "component."),
       integer("seed").at_least(0).otherwise("1").about(
           "Seed of the group's random numbers; the same seed gives the same particles.")},
      "kind"};
  return keys;
}

}  // namespace scree
