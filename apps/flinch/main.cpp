#include "apps/flinch/flinch_main.h"

int main(int argc, char** argv) { return flinch::flinch_main(argc, argv); }
