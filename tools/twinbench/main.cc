#include "tools/twinbench/program.h"

int main(int argc, char** argv) {
  return twinbench::tools::Main(argc, argv);
}
