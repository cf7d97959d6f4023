// Feeds a fuzzer's function with each file of some folders, in place of libFuzzer:  fuzz_NAME FOLDER ...
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

int main(int count, char** words) {
  std::vector<std::filesystem::path> files;
  for (int k = 1; k < count; ++k) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(words[k])) {
      if (entry.is_regular_file()) files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  for (const std::filesystem::path& file : files) {
    std::printf("%s\n", file.c_str());  // the last one is the file that ends the program
    std::fflush(stdout);
    std::ifstream in(file, std::ios::binary);
    const std::string content(std::istreambuf_iterator<char>(in), {});
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(content.data()), content.size());
  }
  if (files.empty()) std::fprintf(stderr, "no file to read\n");
  return files.empty() ? 1 : 0;
}
