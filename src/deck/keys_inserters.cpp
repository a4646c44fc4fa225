// Keys of inserters and outlets.
#include "deck/choices.hpp"
#include "deck/keys.hpp"

namespace scree {

namespace {

void add(std::vector<Key>& keys, std::vector<Key> more) { keys.insert(keys.end(), more.begin(), more.end()); }

std::vector<Key> region_keys() {
  using Kind = InserterKind;
  return {
      vector("min", "m").only_for({Kind::box}).required().about("Lower corner of the box."),
      vector("max", "m").only_for({Kind::box}).required().about("Upper corner of the box."),
      vectors("ends", "m")
          .only_for({Kind::cylinder})
          .entries(2)
          .required()
          .about("The two ends of the cylinder's axis."),
      vector("center", "m")
          .only_for({Kind::sphere, Kind::face})
          .required()
          .about("Centre of the sphere (2D: of the circle), or of the face."),
      real("region_radius", "m")
          .only_for({Kind::cylinder, Kind::sphere, Kind::face})
          .required_for<Kind>({Kind::cylinder, Kind::sphere})
          .above(0)
          .left_out("a face: width is given")
          .about("Radius of the cylinder or the sphere, or of a round face (3D)."),
      text("mesh")
          .only_for({Kind::mesh})
          .required()
          .about(
              "A closed mesh whose inside is the region, in its pose at t = 0 on the wall or the body that "
              "has it, otherwise in the global frame; the region moves only with on. If the mesh collides, "
              "it must be a shell (a file with sheet = true): the inside of other closed meshes is solid."),
      vector("normal", "")
          .only_for({Kind::face})
          .left_out("the direction of velocity")
          .about("Normal of the face, of any length; must point to the side that velocity leads to."),
      real("width", "m")
          .only_for({Kind::face})
          .above(0)
          .left_out("region_radius is given")
          .about("Width of a rectangular face; in 2D the length of the face."),
      real("height", "m")
          .only_for({Kind::face})
          .above(0)
          .left_out("equal to width")
          .about("3D: height of a rectangular face, perpendicular to width."),
      vector("width_axis", "")
          .only_for({Kind::face})
          .left_out("3D: the global axis that is most nearly across the normal")
          .about("3D: direction of width, of any length; its component along the normal is removed."),
      text("on")
          .left_out("the region is at rest")
          .about("A body, or a wall with a mesh or a motion, with which the region moves. The other keys "
                 "give the region at t = 0 in the global frame."),
  };
}

std::vector<Key> amount_keys() {
  return {
      integer("number")
          .within(1, 1000000000)
          .left_out("no limit")
          .about("Total number of particles. Without a rate all of them are due at start or, if end is "
                 "given, uniformly from start to end."),
      real("mass_total", "kg")
          .above(0)
          .left_out("no limit")
          .about("Total mass of the particles, in place of number; births end before it would be exceeded."),
      real("solid_fraction", "")
          .within(0, 1)
          .above(0)
          .left_out("none")
          .about("Total volume of the particles over that of the region (2D: areas), in place of number."),
      real("number_rate", "1/s").above(0).left_out("no rate").about("Rate of the number of particles."),
      real("mass_rate", "kg/s").above(0).left_out("no rate").about("Rate of the mass of particles."),
      reals("rate_times", "s")
          .otherwise("[]")
          .about("Increasing times of a table of the rate, in place of start and end."),
      reals("rate_factors", "")
          .at_least(0)
          .otherwise("[]")
          .about("Factors of number_rate or mass_rate at rate_times, with linear interpolation; the rate is "
                 "0 before and after these times."),
      real("start", "s").at_least(0).otherwise("0.0").about("Start of the births."),
      real("end", "s")
          .above(0)
          .left_out("never; number, mass_total and solid_fraction without a rate: start")
          .about("End of the births. Particles that have become due since the last instant are born then, "
                 "whatever the interval is."),
      real("interval", "s")
          .at_least(0)
          .left_out("a face: the time in which the stream moves by the largest diameter; others: the time in "
                    "which a particle at rest falls by the smallest diameter; must be given without gravity")
          .about(
              "At each instant start + k interval all particles that are due are born. A particle of a face "
              "starts where free fall from the face, since it was due, has taken it, so that the density of "
              "the stream does not depend on the interval. Each instant with births rebuilds the neighbour "
              "list: a short interval takes time. 0: births after each step in which particles are due."),
  };
}

std::vector<Key> birth_keys() {
  return {
      vector("velocity", "m/s")
          .otherwise("zero")
          .about("Velocity at birth; with on, it rotates with the body or wall and is relative to it. "
                 "Required for a face."),
      real("random_velocity", "m/s")
          .at_least(0)
          .otherwise("0.0")
          .about("Half-width of the uniform distribution of a random part that is added to each velocity "
                 "component."),
      real("gap", "m")
          .at_least(0)
          .otherwise("0.0")
          .about("Smallest distance of the surface of a particle at birth from other particles and from "
                 "walls and bodies."),
      integer("tries").within(1, 10000).otherwise("50").about(
          "Number of random positions that are tried for a particle at one instant."),
      choice<BlockedPolicy>("blocked")
          .otherwise_choice(BlockedPolicy::wait)
          .about("What happens to a particle for which no free position is found. Wait: it is tried again at "
                 "the next instant, before particles that are due later. Drop: it is left out. Error: the "
                 "run ends with an error. Waiting and dropped particles are counted in the history."),
      integer("most_waiting")
          .at_least(0)
          .left_out("any number")
          .about("With blocked = \"wait\": the run ends with an error if more particles than this wait."),
      integer("seed").at_least(0).otherwise("1").about(
          "Seed of the inserter's random numbers; inserters with the same seed use the same random numbers."),
  };
}

}  // namespace

const TableKeys& inserter_keys() {
  static const TableKeys keys = [] {
    TableKeys all{
        "Inserters: regions in which particles are born during the run. The amount that is due is a function "
        "of time alone and does not depend on steps, ranks or restarts.",
        {name_key().required().about("Name, for the history and messages."),
         choice<InserterKind>("kind").required().about(
             "Box, cylinder (3D), sphere (2D: circle): regions in which particles are born. Mesh: the inside "
             "of a mesh. Face: a plane rectangle or disc (2D: a line) through which particles enter with a "
             "velocity.")},
        "kind"};
    add(all.keys, region_keys());
    add(all.keys, amount_keys());
    add(all.keys, mixture_list_keys());
    add(all.keys, birth_keys());
    return all;
  }();
  return keys;
}

const TableKeys& outlet_keys() {
  using Kind = OutletKind;
  static const TableKeys keys{
      "Outlets: regions in which particles are removed during the run, and counted; at most eight. A "
      "particle is removed when its centre is in the region, and inside the domain, at an instant of the "
      "outlet.",
      {name_key().required().about("Name, for the history and messages."),
       choice<Kind>("kind").required().about(
           "Box, cylinder (3D), sphere (2D: circle): regions. Plane: everything beyond a plane."),
       vector("min", "m").only_for({Kind::box}).required().about("Lower corner of the box."),
       vector("max", "m").only_for({Kind::box}).required().about("Upper corner of the box."),
       vectors("ends", "m")
           .only_for({Kind::cylinder})
           .entries(2)
           .required()
           .about("The two ends of the cylinder's axis."),
       vector("center", "m").only_for({Kind::sphere}).required().about("Centre of the sphere."),
       real("region_radius", "m")
           .only_for({Kind::cylinder, Kind::sphere})
           .required()
           .above(0)
           .about("Radius of the cylinder or the sphere."),
       vector("point", "m").only_for({Kind::plane}).required().about("A point of the plane."),
       vector("normal", "")
           .only_for({Kind::plane})
           .required()
           .about("Normal of the plane, of any length, towards the side on which particles are removed."),
       text("on")
           .left_out("the region is at rest")
           .about("A body, or a wall with a mesh or a motion, with which the region moves. The other keys "
                  "give the region at t = 0 in the global frame."),
       real("start", "s").at_least(0).otherwise("0.0").about("Time from which on particles are removed."),
       real("end", "s").above(0).left_out("never").about("Time until which particles are removed."),
       real("interval", "s")
           .above(0)
           .left_out("the time in which a particle at rest falls by the smallest diameter; must be given "
                     "without gravity")
           .about("Particles are removed at the instants start + k interval. Each removal rebuilds the "
                  "neighbour list: a short interval takes time, and with a long one particles move farther "
                  "into the region.")},
      "kind"};
  return keys;
}

}  // namespace scree
