#include "mbs/petsc_solver.hpp"

#include <fmt/format.h>
#include <petscksp.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "base/error.hpp"
#include "mbs/petsc_session.hpp"
#include "mbs/single_solution.hpp"
#if SCREE_REFACTORS
#include "mbs/klu_factors.hpp"
#include "mbs/petsc_klu.hpp"
#endif

namespace scree {

namespace {

constexpr const char* kPrefix = "mbs_";
constexpr int kOwnArguments = 5;  // leading arguments set by PetscSession

// Factor packages in the order of their measured speed on chains of bodies.
constexpr std::array kPackages = {
#if SCREE_REFACTORS
    kKluRefactor,
#endif
    MATSOLVERKLU, MATSOLVERSUPERLU, MATSOLVERUMFPACK, MATSOLVERMUMPS, MATSOLVERPETSC};

// The first message of PETSc's current error; its handler reports the innermost function first.
std::string& petsc_message() {
  static std::string message;
  return message;
}

PetscErrorCode keep_message(MPI_Comm, int, const char*, const char*, PetscErrorCode code, PetscErrorType type,
                            const char* message, void*) {
  if (type == PETSC_ERROR_INITIAL) petsc_message() = message != nullptr ? message : "no message";
  return code;
}

bool failed(PetscErrorCode code) { return static_cast<int>(code) != 0; }

// Codes by which factor packages report a zero pivot; KLU's is the one of any external library.
bool is_singular(PetscErrorCode code) {
  return code == PETSC_ERR_LIB || code == PETSC_ERR_MAT_LU_ZRPVT || code == PETSC_ERR_MAT_CH_ZRPVT;
}

void check(PetscErrorCode code) {
  if (failed(code)) throw SimulationError(fmt::format("PETSc, rank 0: {}", petsc_message()));
}

void check_option(PetscErrorCode code) {
  if (failed(code)) throw InputError(fmt::format("PETSc option: {}", petsc_message()));
}

bool is_option_name(const std::string& word) {
  return word.size() > 1 && word[0] == '-' &&
         (std::isalpha(static_cast<unsigned char>(word[1])) || word[1] == '-');
}

}  // namespace

PetscSession::PetscSession(const std::string& program, const std::vector<std::string>& options) {
  for (std::size_t i = 0; i < options.size(); ++i) {
    if (!is_option_name(options[i]) && (i == 0 || !is_option_name(options[i - 1]))) {
      throw InputError(fmt::format(
          "'{}' is not a PETSc option: an option starts with '-', e.g. -mbs_ksp_view", options[i]));
    }
  }
  // A run depends on its deck and its command line, not on files in the user's home; signals belong to the
  // program; unused options are reported through unused_options().
  words_ = {program, "-skip_petscrc", "-no_signal_handler", "-options_left", "no"};
  static_assert(kOwnArguments == 5);
  words_.insert(words_.end(), options.begin(), options.end());
  for (std::string& word : words_) arguments_.push_back(word.data());
  arguments_.push_back(nullptr);
  int count = static_cast<int>(words_.size());
  char** arguments = arguments_.data();
  PETSC_COMM_WORLD = MPI_COMM_SELF;
  if (failed(PetscInitialize(&count, &arguments, nullptr, nullptr))) {
    throw InputError(fmt::format("PETSc refuses its options: {}", fmt::join(options, " ")));
  }
  check(PetscPushErrorHandler(keep_message, nullptr));
}

PetscSession::~PetscSession() {
  PetscPopErrorHandler();
  PetscFinalize();
}

std::vector<std::string> PetscSession::unused_options() const {
  PetscInt count = 0;
  char **names = nullptr, **values = nullptr;
  check(PetscOptionsLeftGet(nullptr, &count, &names, &values));
  std::vector<std::string> unused;
  for (PetscInt i = 0; i < count; ++i) {
    const bool given =
        std::find(words_.begin() + kOwnArguments, words_.end(), fmt::format("-{}", names[i])) != words_.end();
    if (!given) continue;
    unused.push_back(fmt::format("-{}{}{}", names[i], values[i] ? " " : "", values[i] ? values[i] : ""));
  }
  check(PetscOptionsLeftRestore(nullptr, &count, &names, &values));
  return unused;
}

std::string petsc_version() {
  PetscInt major = 0, minor = 0, subminor = 0;
  check(PetscGetVersionNumber(&major, &minor, &subminor, nullptr));
  return fmt::format("{}.{}.{}", major, minor, subminor);
}

struct PetscSolver::Impl {
  explicit Impl(const SparsePattern& sparse_pattern)
      : pattern(sparse_pattern),
        values(pattern.column.size()),
        rhs(static_cast<std::size_t>(pattern.rows())),
        solution(rhs.size()) {}
  ~Impl();
  void create();
  void choose_package();
  bool is_available(const char* package);
  bool solve(bool refactor);
  bool solve_by_petsc(bool refactor);
  bool is_finite() const;
#if SCREE_REFACTORS
  bool factor_directly();
  bool solve_directly(bool refactor);
  bool is_plain() const;
  void find_factors();
#endif
  void multiply(bool back);
  static std::string likely_description();

  SparsePattern pattern;
  std::vector<Real> values, rhs, solution, units;
  Mat matrix = nullptr;
  Vec rhs_vector = nullptr, solution_vector = nullptr;
  KSP solver = nullptr;
  PC preconditioner = nullptr;  // owned by the solver
#if SCREE_REFACTORS
  bool plain = false;             // solutions need nothing of PETSc but the factors
  KluFactors* factors = nullptr;  // of the solver, once a plain one has some
#endif
};

PetscSolver::Impl::~Impl() {
  KSPDestroy(&solver);
  VecDestroy(&solution_vector);
  VecDestroy(&rhs_vector);
  MatDestroy(&matrix);
}

bool PetscSolver::Impl::is_available(const char* package) {
  PetscBool available = PETSC_FALSE;
  check(MatGetFactorAvailable(matrix, package, MAT_FACTOR_LU, &available));
  return available == PETSC_TRUE;
}

// The user's choice is needed before KSPSetFromOptions applies it: PETSc's own LU does not pivot, and the
// zero block needs rows ordered for nonzeros on the diagonal, which the other packages do not expect.
void PetscSolver::Impl::choose_package() {
  std::array<char, 64> chosen{};
  PetscBool given = PETSC_FALSE;
  check_option(PetscOptionsGetString(nullptr, kPrefix, "-pc_factor_mat_solver_type", chosen.data(),
                                     chosen.size(), &given));
  std::string package = chosen.data();
  if (given && !is_available(package.c_str())) {
    std::string names;
    for (const char* name : kPackages) {
      if (is_available(name)) names += fmt::format("{}{}", names.empty() ? "" : ", ", name);
    }
    throw InputError(fmt::format("-{}pc_factor_mat_solver_type {}: this PETSc has no such LU; it has {}",
                                 kPrefix, package, names));
  }
  for (std::size_t i = 0; package.empty() && i < kPackages.size(); ++i) {
    if (is_available(kPackages[i])) package = kPackages[i];
  }
  check(PCFactorSetMatSolverType(preconditioner, package.c_str()));
  if (package == MATSOLVERPETSC) {
    check(PCFactorSetMatOrderingType(preconditioner, MATORDERINGNATURAL));
    check(PCFactorReorderForNonzeroDiagonal(preconditioner, PETSC_DECIDE));
  }
}

void PetscSolver::Impl::create() {
#if SCREE_REFACTORS
  check(register_klu_refactor());
#endif
  const PetscInt n = pattern.rows();
  // PETSc uses these arrays in place; nothing is copied.
  check(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, n, n, pattern.row_start.data(), pattern.column.data(),
                                  values.data(), &matrix));
#if SCREE_REFACTORS
  check(attach_pattern(matrix, pattern));
#endif
  check(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, rhs.data(), &rhs_vector));
  check(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, solution.data(), &solution_vector));
  check(KSPCreate(PETSC_COMM_SELF, &solver));
  check(KSPSetOptionsPrefix(solver, kPrefix));
  check(KSPSetOperators(solver, matrix, matrix));
  check(KSPSetType(solver, KSPPREONLY));
  check(KSPGetPC(solver, &preconditioner));
  check(PCSetType(preconditioner, PCLU));
  choose_package();
  check_option(KSPSetFromOptions(solver));
#if SCREE_REFACTORS
  plain = is_plain();
#endif
}

PetscSolver::PetscSolver(const SparsePattern& pattern) : impl_(std::make_unique<Impl>(pattern)) {
  PetscBool started = PETSC_FALSE;
  PetscInitialized(&started);
  if (started == PETSC_TRUE) impl_->create();
}
PetscSolver::~PetscSolver() = default;

std::span<Real> PetscSolver::values() { return impl_->values; }
std::span<Real> PetscSolver::rhs() { return impl_->rhs; }
std::span<const Real> PetscSolver::solution() const { return impl_->solution; }

void PetscSolver::set_units(std::vector<Real> units) { impl_->units = std::move(units); }

// Multiplies matrix and right-hand side by the units, or divides by them.
void PetscSolver::Impl::multiply(bool back) {
  const auto times = [&](Real& value, Real unit) { value = back ? value / unit : value * unit; };
  for (int row = 0; row < pattern.rows(); ++row) {
    const std::size_t i = static_cast<std::size_t>(row);
    for (int k = pattern.row_start[i]; k < pattern.row_start[i + 1]; ++k) {
      const std::size_t entry = static_cast<std::size_t>(k);
      times(values[entry], units[i] * units[static_cast<std::size_t>(pattern.column[entry])]);
    }
    times(rhs[i], units[i]);
  }
}

bool PetscSolver::solve(bool refactor) {
  if (impl_->units.empty()) return impl_->solve(refactor);
  impl_->multiply(false);
  const bool solved = impl_->solve(refactor);
  impl_->multiply(true);
  for (std::size_t i = 0; i < impl_->units.size(); ++i) impl_->solution[i] *= impl_->units[i];
  return solved;
}

bool PetscSolver::factor() {
#if SCREE_REFACTORS
  if (impl_->factors == nullptr) return false;
  if (impl_->units.empty()) return impl_->factor_directly();
  impl_->multiply(false);
  const bool factored = impl_->factor_directly();
  impl_->multiply(true);
  return factored;
#else
  return false;
#endif
}

bool PetscSolver::Impl::is_finite() const {
  bool finite = true;
  for (const Real x : solution) finite = finite && std::isfinite(x);
  return finite;
}

bool PetscSolver::Impl::solve(bool refactor) {
  if (solver == nullptr) return solve_once(pattern, values, rhs, solution);
#if SCREE_REFACTORS
  if (factors != nullptr) return solve_directly(refactor);
#endif
  return solve_by_petsc(refactor);
}

bool PetscSolver::Impl::solve_by_petsc(bool refactor) {
  // Taking and returning an array tells PETSc that its contents changed.
  Real* array = nullptr;
  if (refactor) {
    check(MatSeqAIJGetArrayWrite(matrix, &array));
    check(MatSeqAIJRestoreArrayWrite(matrix, &array));
  }
  check(VecGetArrayWrite(rhs_vector, &array));
  check(VecRestoreArrayWrite(rhs_vector, &array));
  // Factoring here instead of within KSPSolve leaves the solver usable after a matrix that cannot be
  // factored.
  PetscErrorCode factored = KSPSetUp(solver);
  if (!failed(factored)) factored = PCSetUp(preconditioner);
  if (is_singular(factored)) return false;
  check(factored);
  check(KSPSolve(solver, rhs_vector, solution_vector));
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  check(KSPGetConvergedReason(solver, &reason));
#if SCREE_REFACTORS
  if (plain) find_factors();
#endif
  return reason > 0 && is_finite();
}

#if SCREE_REFACTORS
// With the defaults a solution is one with the factors, and the calls of PETSc around it take longer than the
// factors of a small matrix need. Options of the user act within these calls.
bool PetscSolver::Impl::is_plain() const {
  char* options = nullptr;
  check(PetscOptionsGetAll(nullptr, &options));
  const bool given = std::string(options).find(fmt::format("-{}", kPrefix)) != std::string::npos;
  check(PetscFree(options));
  MatSolverType package = nullptr;
  check(PCFactorGetMatSolverType(preconditioner, &package));
  return !given && package != nullptr && package == std::string(kKluRefactor);
}

void PetscSolver::Impl::find_factors() {
  Mat factor = nullptr;
  check(PCFactorGetMatrix(preconditioner, &factor));
  check(factors_of(factor, &factors));
}

bool PetscSolver::Impl::factor_directly() {
  const KluFactors::Result result = factors->factor(values);
  if (result == KluFactors::Result::out_of_memory) throw SimulationError("KLU, rank 0: out of memory");
  return result != KluFactors::Result::singular;
}

bool PetscSolver::Impl::solve_directly(bool refactor) {
  if (refactor && !factor_directly()) return false;
  std::copy(rhs.begin(), rhs.end(), solution.begin());
  if (!factors->solve(solution)) throw SimulationError("KLU, rank 0: it cannot solve");
  return is_finite();
}
#endif

// Description of a solver without a session, by PETSc's configuration and the order of the packages.
std::string PetscSolver::Impl::likely_description() {
#if SCREE_REFACTORS
  const char* const package = kKluRefactor;
#elif defined(PETSC_HAVE_SUITESPARSE)
  const char* const package = MATSOLVERKLU;
#elif defined(PETSC_HAVE_SUPERLU)
  const char* const package = MATSOLVERSUPERLU;
#elif defined(PETSC_HAVE_MUMPS)
  const char* const package = MATSOLVERMUMPS;
#else
  const char* const package = MATSOLVERPETSC;
#endif
  return fmt::format("petsc {}, {} + {} ({})", petsc_version(), KSPPREONLY, PCLU, package);
}

std::string PetscSolver::description() const {
  const std::string without_klu =
      SCREE_REFACTORS == 0 ? ", built without KLU: every matrix is factored anew" : "";
  if (impl_->solver == nullptr) return Impl::likely_description() + without_klu;
  KSPType method = nullptr;
  PCType preconditioner_type = nullptr;
  check(KSPGetType(impl_->solver, &method));
  check(PCGetType(impl_->preconditioner, &preconditioner_type));
  std::string text = fmt::format("petsc {}, {} + {}", petsc_version(), method, preconditioner_type);
  MatSolverType package = nullptr;
  if (std::string(preconditioner_type) == PCLU) {
    check(PCFactorGetMatSolverType(impl_->preconditioner, &package));
  }
  if (package != nullptr) text += fmt::format(" ({})", package);
  return text + without_klu;
}

}  // namespace scree
