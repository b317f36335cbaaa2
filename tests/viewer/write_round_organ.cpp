// SPDX-License-Identifier: Apache-2.0
// write_round_organ FILE [SUBDIVISIONS [NODULE_ABOVE [force]]]: the tests' round organ as a model file, for tests that are no
// C++ programs. NODULE_ABOVE: height of its border over the radius; without it there is one material. force: the model's
// parameter is the force, and the nodule is called Knötchen.
#include <cstdlib>
#include <exception>
#include <iostream>

#include "palpate/testing/synthetic_model.h"
#include "tools/modelfile/write_model.h"

int main(int argc, char** argv) {
  if (argc < 2) {
    std::cerr << "Usage: write_round_organ FILE [SUBDIVISIONS [NODULE_ABOVE [force]]]\n";
    return 2;
  }
  try {
    // Some 2,500 nodes, stiffer at one place than at another.
    const int subdivisions = argc > 2 ? std::atoi(argv[2]) : 4;
    palpate::testing::SyntheticOptions options{
        .subdivisions = subdivisions, .near_radius = 0.025, .contrast = 0.3};
    if (argc > 3) options.nodule_above = std::atof(argv[3]);
    const bool force = argc > 4;
    if (force) options.parameters = palpate::Parameters::kForce;
    palpate::modelfile::ModelData data = palpate::testing::syntheticModel(options);
    if (force) data.region_name.back() = palpate::regionName("Knötchen");
    palpate::modelfile::writeModel(argv[1], data);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "write_round_organ: " << error.what() << "\n";
    return 1;
  }
}
