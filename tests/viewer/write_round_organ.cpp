// SPDX-License-Identifier: Apache-2.0
// write_round_organ FILE [SUBDIVISIONS [NODULE_ABOVE]]: the tests' round organ as a model file, for tests that are no C++
// programs. NODULE_ABOVE: height of its border over the radius; without it there is one material.
#include <cstdlib>
#include <exception>
#include <iostream>

#include "palpate/testing/synthetic_model.h"

int main(int argc, char** argv) {
  if (argc < 2) {
    std::cerr << "Usage: write_round_organ FILE [SUBDIVISIONS [NODULE_ABOVE]]\n";
    return 2;
  }
  try {
    // Some 2,500 nodes, stiffer at one place than at another.
    const int subdivisions = argc > 2 ? std::atoi(argv[2]) : 4;
    palpate::testing::SyntheticOptions options{
        .subdivisions = subdivisions, .near_radius = 0.025, .contrast = 0.3};
    if (argc > 3) options.nodule_above = std::atof(argv[3]);
    palpate::testing::writeSyntheticModel(argv[1], options);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "write_round_organ: " << error.what() << "\n";
    return 1;
  }
}
