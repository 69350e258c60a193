// Prints the face count that a PM file's prologue states: the installed package, used from outside.
#include <fstream>
#include <iostream>
#include <iterator>

#include "core/pm/format.h"

int main(int, char** argv) {
  std::ifstream in(argv[1], std::ios::binary);
  const pmesh::Bytes bytes(std::istreambuf_iterator<char>(in), {});
  const auto index = pmesh::parse_prologue(bytes);
  if (!index.ok() || !index->has_value()) return 1;
  std::cout << (*index)->header.faces << " faces\n";
}
