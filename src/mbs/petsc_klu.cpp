#include "mbs/petsc_klu.hpp"

#include <memory>

#include "mbs/klu_factors.hpp"

namespace scree {

namespace {

constexpr PetscErrorCode kSuccess{};

// The name under which a matrix carries its pattern.
constexpr const char* kPattern = "scree_pattern";

// KLU's codes for the values of PETSc's options. A scaling of -1 means none, and no check of the pattern
// either.
PetscErrorCode read_options(const char* prefix, klu_common& options, PetscBool* ordered) {
  const char* const orderings[] = {"AMD", "COLAMD"};
  const char* const scalings[] = {"NONE", "SUM", "MAX"};
  PetscInt ordering = 0, scaling = 0, btf = options.btf;
  PetscReal tolerance = options.tol;
  PetscFunctionBegin;
  PetscCall(PetscOptionsGetReal(nullptr, prefix, "-mat_klu_pivot_tol", &tolerance, nullptr));
  PetscCall(PetscOptionsGetInt(nullptr, prefix, "-mat_klu_use_btf", &btf, nullptr));
  PetscCall(PetscOptionsGetEList(nullptr, prefix, "-mat_klu_ordering", orderings, 2, &ordering, ordered));
  PetscCall(PetscOptionsGetEList(nullptr, prefix, "-mat_klu_row_scale", scalings, 3, &scaling, nullptr));
  options.tol = tolerance;
  options.btf = static_cast<int>(btf);
  options.ordering = static_cast<int>(ordering);
  options.scale = scaling == 0 ? -1 : static_cast<int>(scaling);
  PetscFunctionReturn(kSuccess);
}

PetscErrorCode factor_symbolic(Mat factor, Mat matrix, IS, IS, const MatFactorInfo*) {
  KluFactors* factors = nullptr;
  const char* prefix = nullptr;
  const PetscInt *row_start = nullptr, *column = nullptr;
  PetscInt rows = 0;
  PetscBool done = PETSC_FALSE, ordered = PETSC_FALSE;
  PetscObject attached = nullptr;
  void* given = nullptr;
  PetscFunctionBegin;
  PetscCall(factors_of(factor, &factors));
  PetscCall(MatGetOptionsPrefix(factor, &prefix));
  PetscCall(read_options(prefix, factors->options(), &ordered));
  PetscCall(PetscObjectQuery(reinterpret_cast<PetscObject>(matrix), kPattern, &attached));
  if (attached != nullptr)
    PetscCall(PetscContainerGetPointer(reinterpret_cast<PetscContainer>(attached), &given));
  PetscCall(MatGetRowIJ(matrix, 0, PETSC_FALSE, PETSC_FALSE, &rows, &row_start, &column, &done));
  PetscCheck(done, PETSC_COMM_SELF, PETSC_ERR_SUP, "KLU: the matrix is not one of compressed rows");
  const SparsePattern pattern{
      {row_start, row_start + rows + 1},
      {column, column + row_start[rows]},
      given == nullptr ? -1 : static_cast<const SparsePattern*>(given)->first_weak_diagonal};
  PetscCall(MatRestoreRowIJ(matrix, 0, PETSC_FALSE, PETSC_FALSE, &rows, &row_start, &column, &done));
  PetscCheck(factors->analyze(pattern, ordered == PETSC_TRUE), PETSC_COMM_SELF, PETSC_ERR_LIB,
             "KLU finds no ordering");
  PetscFunctionReturn(kSuccess);
}

PetscErrorCode factor_numeric(Mat factor, Mat matrix, const MatFactorInfo*) {
  KluFactors* factors = nullptr;
  const PetscScalar* values = nullptr;
  MatInfo info;
  PetscFunctionBegin;
  PetscCall(factors_of(factor, &factors));
  PetscCall(MatGetInfo(matrix, MAT_LOCAL, &info));
  PetscCall(MatSeqAIJGetArrayRead(matrix, &values));
  const KluFactors::Result result = factors->factor({values, static_cast<std::size_t>(info.nz_used)});
  PetscCall(MatSeqAIJRestoreArrayRead(matrix, &values));
  PetscCheck(result != KluFactors::Result::out_of_memory, PETSC_COMM_SELF, PETSC_ERR_MEM,
             "KLU: out of memory");
  PetscCheck(result != KluFactors::Result::singular, PETSC_COMM_SELF, PETSC_ERR_MAT_LU_ZRPVT,
             "KLU: the matrix is singular");
  PetscFunctionReturn(kSuccess);
}

using Solve = bool (KluFactors::*)(std::span<Real>);

template <Solve solve>
PetscErrorCode solve_with(Mat factor, Vec rhs, Vec solution) {
  KluFactors* factors = nullptr;
  PetscScalar* values = nullptr;
  PetscInt rows = 0;
  PetscFunctionBegin;
  PetscCall(factors_of(factor, &factors));
  PetscCall(VecCopy(rhs, solution));
  PetscCall(VecGetLocalSize(solution, &rows));
  PetscCall(VecGetArray(solution, &values));
  const bool solved = (factors->*solve)({values, static_cast<std::size_t>(rows)});
  PetscCall(VecRestoreArray(solution, &values));
  PetscCheck(solved, PETSC_COMM_SELF, PETSC_ERR_LIB, "KLU cannot solve");
  PetscFunctionReturn(kSuccess);
}

PetscErrorCode no_information(Mat, MatInfoType, MatInfo* info) {
  *info = MatInfo{};
  return kSuccess;
}

PetscErrorCode solver_type(Mat, MatSolverType* type) {
  *type = kKluRefactor;
  return kSuccess;
}

PetscErrorCode destroy(void* factors) {
  delete static_cast<KluFactors*>(factors);
  return kSuccess;
}

template <class Function>
PetscErrorCode set_operation(Mat factor, MatOperation operation, Function* function) {
  return MatShellSetOperation(factor, operation, reinterpret_cast<void (*)()>(function));
}

PetscErrorCode make_factor(Mat matrix, MatFactorType type, Mat* factor) {
  PetscInt rows = 0, columns = 0;
  PetscFunctionBegin;
  PetscCall(MatGetSize(matrix, &rows, &columns));
  auto factors = std::make_unique<KluFactors>();
  PetscCall(MatCreateShell(PETSC_COMM_SELF, rows, columns, rows, columns, factors.get(), factor));
  PetscCall(MatShellSetContextDestroy(*factor, destroy));
  factors.release();  // owned by the matrix from here on
  PetscCall(set_operation(*factor, MATOP_LUFACTOR_SYMBOLIC, factor_symbolic));
  PetscCall(set_operation(*factor, MATOP_LUFACTOR_NUMERIC, factor_numeric));
  PetscCall(set_operation(*factor, MATOP_SOLVE, solve_with<&KluFactors::solve>));
  PetscCall(set_operation(*factor, MATOP_SOLVE_TRANSPOSE, solve_with<&KluFactors::solve_transposed>));
  PetscCall(set_operation(*factor, MATOP_GETINFO, no_information));
  PetscCall(PetscObjectComposeFunction(reinterpret_cast<PetscObject>(*factor), "MatFactorGetSolverType_C",
                                       solver_type));
  PetscCall(MatSetFactorType(*factor, type));
  PetscFunctionReturn(kSuccess);
}

}  // namespace

PetscErrorCode factors_of(Mat factor, KluFactors** factors) {
  PetscFunctionBegin;
  PetscCall(MatShellGetContext(factor, factors));
  PetscFunctionReturn(kSuccess);
}

PetscErrorCode attach_pattern(Mat matrix, const SparsePattern& pattern) {
  PetscContainer container = nullptr;
  PetscFunctionBegin;
  PetscCall(PetscContainerCreate(PETSC_COMM_SELF, &container));
  PetscCall(PetscContainerSetPointer(container, const_cast<SparsePattern*>(&pattern)));
  PetscCall(PetscObjectCompose(reinterpret_cast<PetscObject>(matrix), kPattern,
                               reinterpret_cast<PetscObject>(container)));
  PetscCall(PetscContainerDestroy(&container));  // the matrix holds its own reference
  PetscFunctionReturn(kSuccess);
}

PetscErrorCode register_klu_refactor() {
  PetscFunctionBegin;
  // PETSc's own packages first: PETSc 3.18 does not register them afterwards.
  PetscCall(MatInitializePackage());
  PetscCall(MatSolverTypeRegister(kKluRefactor, MATSEQAIJ, MAT_FACTOR_LU, make_factor));
  PetscFunctionReturn(kSuccess);
}

}  // namespace scree
