// The `grove` program: experiments with the structures and shadow methods of the registries.
#include "experiments/commands/program.hpp"

int main(int argc, char** argv) {
    return experiments::commands::run_program(argc, argv,
                                              {structures::registry(), shadows::registry()});
}
