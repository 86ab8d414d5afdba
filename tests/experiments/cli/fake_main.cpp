// The program with the test's own structure and methods.
#include "experiments/commands/program.hpp"
#include "tests/experiments/cli/fake_rows.hpp"

int main(int argc, char** argv) {
    return experiments::commands::run_program(argc, argv, tests::fake_registries());
}
