// Keys of conditions that end a run, and of regions whose particles the history counts.
#include "deck/choices.hpp"
#include "deck/keys.hpp"

namespace scree {

const TableKeys& stop_keys() {
  static const std::string kUnit = "the column's unit";
  static const TableKeys keys{
      "Conditions on columns of the history. The run ends after the first step with a row of the history at "
      "which one of them is met. Conditions are evaluated only at rows of the history: "
      "output.history_interval is their resolution in time, and the row at t = 0 never ends a run. The run "
      "ends as at time.end: last snapshot, checkpoint_end.h5, exit code 0.",
      {name_key().left_out("none").about("Name for messages and for --set stop.NAME.key=value."),
       text("column").required().about(
           "Column of the history as GROUP/NAME: \"energy/kinetic\", \"contacts/drum/torque_z\", "
           "\"regions/outlet/mass\"."),
       real("above", kUnit)
           .left_out("below or within is given")
           .about("The condition holds at rows at which the column is above this value."),
       real("below", kUnit)
           .left_out("above or within is given")
           .about("The condition holds at rows at which the column is below this value."),
       real("within", kUnit)
           .at_least(0)
           .left_out("above or below is given")
           .about("The condition holds where the column is steady: its largest and smallest value at the "
                  "rows of the time `over` differ by no more than this value."),
       real("over", "s")
           .at_least(0)
           .otherwise("0.0")
           .about("The condition is met when it has held at every row for this time. 0: at one row. Must be "
                  "above 0 with within."),
       real("after", "s").at_least(0).otherwise("0.0").about("Rows before this time do not count.")},
      ""};
  return keys;
}

const TableKeys& history_region_keys() {
  using Kind = RegionKind;
  static const TableKeys keys{
      "Regions whose particles are counted: number and mass of the particles whose centres are in the "
      "region, without escaped ones. Along periodic axes positions are wrapped into the domain.",
      {name_key().required().about("Name of the columns: regions/NAME/number and regions/NAME/mass."),
       choice<Kind>("kind").required().about(
           "Box: from min to max. Sphere (2D: circle): radius about center. Cylinder (3D): radius about the "
           "axis between the two ends. The boundary belongs to the region."),
       vector("min", "m").only_for({Kind::box}).required().about("Lower corner."),
       vector("max", "m").only_for({Kind::box}).required().about("Upper corner."),
       vector("center", "m").only_for({Kind::sphere}).required().about("Centre."),
       vectors("ends", "m")
           .only_for({Kind::cylinder})
           .entries(2)
           .required()
           .about("The two ends of the axis."),
       real("radius", "m").above(0).only_for({Kind::sphere, Kind::cylinder}).required().about("Radius.")},
      "kind"};
  return keys;
}

}  // namespace scree
