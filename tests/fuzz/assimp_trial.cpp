// Reads the file of each line on standard input with Assimp alone, and answers with a byte. It may crash, or
// never answer.
#include <unistd.h>

#include <assimp/Importer.hpp>
#include <iostream>
#include <string>

#include "convert/mesh/model_files.h"

int main() {
  for (std::string path; std::getline(std::cin, path);) {
    Assimp::Importer importer;
    importer.SetIOHandler(new pprt::ModelFiles(path));
    importer.ReadFile(path, 0);
    if (write(STDOUT_FILENO, ".", 1) != 1) return 1;
  }
  return 0;
}
