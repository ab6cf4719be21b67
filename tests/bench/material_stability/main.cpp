/// Where materials and light transport go wrong: the formula as textbooks have it in single precision (or the
/// step that is easily left out), and what Parian gives, each against long double or a closed form. Prints
/// the tables of docs/stability.md.
///
/// usage: material_stability
#include "tests/bench/material_stability/report.h"

int main() {
  parian::compare_fresnel();
  parian::compare_facets();
  parian::compare_samples();
  parian::compare_media();
  parian::compare_without_failure();
  return 0;
}
