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
              "A closed mesh whose inside is the region, in its pose on the wall or the body that has it, "
              "otherwise in the global frame. It must be an open surface (a file with sheet = true) or not "
              "collide: the inside of other meshes is solid."),
      vector("normal", "")
          .only_for({Kind::face})
          .left_out("the direction of velocity")
          .about("Direction across the face, of any length."),
      real("width", "m")
          .only_for({Kind::face})
          .above(0)
          .left_out("region_radius is given")
          .about("Width of a rectangular face; in 2D the length of the face."),
      real("height", "m")
          .only_for({Kind::face})
          .above(0)
          .left_out("equal to width")
          .about("3D: height of a rectangular face, across width."),
      vector("width_axis", "")
          .only_for({Kind::face})
          .left_out("3D: the global axis that is most nearly across the normal")
          .about("3D: direction of width, of any length; its part along the normal is left out."),
      text("on")
          .left_out("the region is at rest")
          .about("A body, or a wall with a mesh or a motion, with which the region moves. Its keys give the "
                 "region at "
                 "t = 0 in the global frame."),
  };
}

std::vector<Key> amount_keys() {
  return {
      integer("number")
          .within(1, 1000000000)
          .left_out("no limit")
          .about("Number of particles in all. Without a rate all of them are born at start, or uniformly "
                 "from start "
                 "to end where end is given."),
      real("mass_total", "kg")
          .above(0)
          .left_out("no limit")
          .about(
              "Mass of all particles, in place of number: particles are born as long as it is not exceeded."),
      real("solid_fraction", "")
          .within(0, 1)
          .above(0)
          .left_out("none")
          .about("Volume of all particles over that of the region (2D: areas), in place of number."),
      real("number_rate", "1/s").above(0).left_out("no rate").about("Particles born per time."),
      real("mass_rate", "kg/s").above(0).left_out("no rate").about("Mass born per time."),
      reals("rate_times", "s")
          .otherwise("[]")
          .about("Times of a table of the rate, increasing; they stand for start and end."),
      reals("rate_factors", "")
          .at_least(0)
          .otherwise("[]")
          .about("Factors of the rate at rate_times, with linear interpolation."),
      real("start", "s").at_least(0).otherwise("0.0").about("Begin of the births."),
      real("end", "s")
          .above(0)
          .left_out("never; number, mass_total and solid_fraction without a rate: start")
          .about("End of the births, which is one of their instants whatever the interval is."),
      real("interval", "s")
          .at_least(0)
          .left_out("a face: the time in which the stream moves by the largest diameter; others: the time in "
                    "which a particle at rest falls by the smallest diameter; must be given without gravity")
          .about(
              "Particles are born at start + k interval, at each of these instants all that are due; those "
              "of a face are placed where they have got to since they passed it, so that their distances "
              "do not depend on the interval. Each birth builds the neighbour list: a short interval takes "
              "time. 0: after each step."),
  };
}

std::vector<Key> birth_keys() {
  return {
      vector("velocity", "m/s")
          .otherwise("zero")
          .about("Velocity at birth, relative to the body or wall of on; required for a face."),
      real("random_velocity", "m/s")
          .at_least(0)
          .otherwise("0.0")
          .about("Half-width of the uniform distribution of a random part that is added to each velocity "
                 "component."),
      real("gap", "m")
          .at_least(0)
          .otherwise("0.0")
          .about("Smallest distance of a particle at birth from other particles and from surfaces."),
      integer("tries").within(1, 10000).otherwise("50").about(
          "Number of random positions that are tried for a particle at one instant."),
      choice<BlockedPolicy>("blocked")
          .otherwise_choice(BlockedPolicy::wait)
          .about(
              "What happens to a particle that finds no free position. Wait: it is tried again at the next "
              "instant, before later ones. Drop: it is left out. Error: the run ends. Waiting and dropped "
              "particles are counted in the history."),
      integer("most_waiting")
          .at_least(0)
          .left_out("any number")
          .about("With blocked = \"wait\": the run ends where more particles than this wait."),
      integer("seed").at_least(0).otherwise("1").about(
          "Seed of the inserter's random numbers; the same seed gives the same particles."),
  };
}

}  // namespace

const TableKeys& inserter_keys() {
  static const TableKeys keys = [] {
    TableKeys all{
        "Inserters: regions in which particles are born during the run. How many are due follows from the "
        "time "
        "alone, so that births do not depend on steps, ranks or restarts.",
        {name_key().required().about("Name, for the history and messages."),
         choice<InserterKind>("kind").required().about(
             "Box, cylinder (3D), sphere (2D: circle): regions inside which particles are born. Mesh: the "
             "inside of a mesh. Face: a surface through which particles stream with a velocity.")},
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
      "Outlets: regions in which particles are removed during the run, and counted. A particle is removed "
      "when "
      "its centre is in the region at an instant of the outlet.",
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
           .about("Direction across the plane, of any length, to the side on which particles are removed."),
       text("on")
           .left_out("the region is at rest")
           .about("A body, or a wall with a mesh or a motion, with which the region moves. Its keys give the "
                  "region at "
                  "t = 0 in the global frame."),
       real("start", "s").at_least(0).otherwise("0.0").about("Time from which on particles are removed."),
       real("end", "s").above(0).left_out("never").about("Time until which particles are removed."),
       real("interval", "s")
           .above(0)
           .left_out("the time in which a particle at rest falls by the smallest diameter; must be given "
                     "without gravity")
           .about(
               "Particles are removed at start + k interval. Each removal builds the neighbour list: a short "
               "interval takes time, and with a long one particles get farther into the region.")},
      "kind"};
  return keys;
}

}  // namespace scree
