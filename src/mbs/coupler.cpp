#include "mbs/coupler.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "mbs/joint_coordinate.hpp"

namespace scree {

namespace {

// One term of a coupler: the coordinate of a joint, as a constraint with f = 0, and its coefficient.
struct Term {
  std::unique_ptr<Constraint> coordinate;
  Real coefficient = 1;
};

// C            = sum k_i c_i - C_0
// C_q          = sum k_i (c_i)_q
// velocity_rhs = 0,  acceleration_rhs = sum k_i (acceleration_rhs of c_i)
// (C_q^T lambda)_q = sum of (k_i lambda) (c_i)_qq
class CouplerConstraint final : public Constraint {
 public:
  CouplerConstraint(std::vector<Term> terms, const BodyPoses& start) : terms_(std::move(terms)) {
    offset_ = sum(start);
  }

  // A sum with a displacement is a length, and the coefficients of its angles are lengths; a sum of angles
  // alone is an angle.
  bool is_angle() const override {
    return std::all_of(terms_.begin(), terms_.end(),
                       [](const Term& term) { return term.coordinate->is_angle(); });
  }
  void value(const BodyPoses& poses, Real, Real* c) const override { *c = sum(poses) - offset_; }
  void jacobian(const BodyPoses& poses, int row, SparseTerm& out) const override {
    for (const Term& term : terms_) {
      SparseTerm part;
      term.coordinate->jacobian(poses, row, part);
      for (std::size_t i = 0; i < part.size(); ++i)
        out.add(row, part.column(i), term.coefficient * part.value(i));
    }
  }
  void hessian(const BodyPoses& poses, const Real* lambda, SparseTerm& out) const override {
    for (const Term& term : terms_) {
      const Real part = term.coefficient * *lambda;
      term.coordinate->hessian(poses, &part, out);
    }
  }
  void velocity_rhs(Real, Real* rhs) const override { *rhs = 0; }
  void acceleration_rhs(const BodyPoses& poses, Real t, Real* rhs) const override {
    *rhs = 0;
    for (const Term& term : terms_) {
      Real part = 0;
      term.coordinate->acceleration_rhs(poses, t, &part);
      *rhs += term.coefficient * part;
    }
  }
  void add_reaction(const BodyPoses& poses, const Real* lambda, Vec3& force, Vec3& torque) const override {
    const Real part = terms_.front().coefficient * *lambda;
    terms_.front().coordinate->add_reaction(poses, &part, force, torque);
  }
  Real power(Real, const Real*) const override { return 0; }

 private:
  Real sum(const BodyPoses& poses) const {
    Real sum = 0;
    for (const Term& term : terms_) {
      Real c = 0;
      term.coordinate->value(poses, 0, &c);
      sum += term.coefficient * c;
    }
    return sum;
  }

  std::vector<Term> terms_;
  Real offset_ = 0;
};

}  // namespace

std::unique_ptr<Constraint> make_coupler(const Coupler& coupler, const Model& model, const BodyLayout& layout,
                                         const BodyPoses& start) {
  const std::string title = fmt::format("coupler '{}'", coupler.name);
  std::vector<Term> terms;
  for (std::size_t k = 0; k < coupler.joints.size(); ++k) {
    std::optional<JointCoordinate> wanted;
    if (!coupler.coordinates.empty()) wanted = coupler.coordinates[k];
    terms.push_back(
        {joint_coordinate(title, model, coupler.joints[k], wanted, layout), coupler.coefficients[k]});
  }
  return std::make_unique<CouplerConstraint>(std::move(terms), start);
}

}  // namespace scree
