// SPDX-License-Identifier: MPL-2.0
#pragma once

#if defined(BENCH_HAS_LAPACK)
/// What is used of LAPACK; its names, and all arguments by address, as Fortran has it.
extern "C" {
void dstebz_(const char* range, const char* order, const int* n, const double* vl, const double* vu, const int* il,
             const int* iu, const double* abstol, const double* d, const double* e, int* m, int* nsplit, double* w,
             int* iblock, int* isplit, double* work, int* iwork, int* info);
void dstemr_(const char* jobz, const char* range, const int* n, double* d, double* e, const double* vl,
             const double* vu, const int* il, const int* iu, int* m, double* w, double* z, const int* ldz,
             const int* nzc, int* isuppz, int* tryrac, double* work, const int* lwork, int* iwork, const int* liwork,
             int* info);
void dsterf_(const int* n, double* d, double* e, int* info);
void dlasq1_(const int* n, double* d, double* e, double* work, int* info);
void dsbgv_(const char* jobz, const char* uplo, const int* n, const int* ka, const int* kb, double* ab, const int* ldab,
            double* bb, const int* ldbb, double* w, double* z, const int* ldz, double* work, int* info);
}
#endif
