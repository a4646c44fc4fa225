// Which known name a misspelt one is taken for.
#include "deck/suggestion.hpp"

#include "support/catch.hpp"

namespace scree {

TEST_CASE("a name is suggested that differs by a letter or a quarter of them") {
  const auto meant = [](const std::string& misspelt, const std::string& known) {
    const std::string text = suggestion(misspelt, {known, "something_else"});
    if (text == "; did you mean \"" + known + "\"?") return true;
    CHECK(text == "; known: " + known + ", something_else");
    return false;
  };
  CHECK(meant("stp", "step"));
  CHECK(meant("setp", "step"));  // two neighbours exchanged
  CHECK(meant("resitution", "restitution"));
  CHECK(meant("stifnes", "stiffness"));
  CHECK(meant("GROUND", "ground"));
  CHECK(meant("Ground", "ground"));
  CHECK(meant("p1", "p2"));
  CHECK_FALSE(meant("b", "a"));
  CHECK_FALSE(meant("rod", "bob"));
  CHECK_FALSE(meant("crank", "frame"));
  CHECK_FALSE(meant("direction", "dimension"));
  CHECK_FALSE(meant("", "a"));
}

TEST_CASE("of several names the nearest is suggested, and none where there are none") {
  CHECK(suggestion("joint_sprngs", {"joint_limits", "joint_springs"}) == "; did you mean \"joint_springs\"?");
  CHECK(suggestion("a", {}).empty());
}

}  // namespace scree
