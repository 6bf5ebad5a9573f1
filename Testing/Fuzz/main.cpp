// Fuzz CORPUS TARGET INPUTS [SEED]: hands a reader the files of CORPUS/TARGET, then INPUTS mutations of them, which
// depend on SEED and their number alone. A fault ends the program with what the sanitizer says; the bytes are then in
// /dev/shm/sono_fuzz_PID. Targets.cpp is libFuzzer's as well: build it with -fsanitize=fuzzer instead of this file and
// name the target in SONOVDB_FUZZ.
#include "Mutate.h"
#include "Targets.h"

#include <sys/time.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace {

namespace fs = std::filesystem;
using sono::fuzz::Bytes;

constexpr int slowestS = 60; // of the processor, however busy it is: what takes longer hangs

std::vector<Bytes> corpusOf(const fs::path& folder)
{
  std::vector<fs::path> paths;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
  {
    paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  std::vector<Bytes> corpus;
  for (const fs::path& path : paths)
  {
    std::ifstream stream(path, std::ios::binary);
    corpus.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  return corpus;
}

} // namespace

int main(int argc, char** argv)
{
  if (argc < 4)
  {
    std::fprintf(stderr, "Fuzz CORPUS TARGET INPUTS [SEED]; the targets are");
    for (const sono::fuzz::Target& target : sono::fuzz::targets())
    {
      std::fprintf(stderr, " %s", target.name.c_str());
    }
    std::fprintf(stderr, "\n");
    return 2;
  }
  setenv("SONOVDB_FUZZ", argv[2], 1);
  const std::vector<Bytes> corpus = corpusOf(fs::path(argv[1]) / argv[2]);
  const std::uint64_t inputs = std::strtoull(argv[3], nullptr, 10);
  const std::uint64_t seed = argc > 4 ? std::strtoull(argv[4], nullptr, 10) : 1;
  for (const Bytes& bytes : corpus)
  {
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  }
  const itimerval longest{ {}, { slowestS, 0 } };
  for (std::uint64_t n = 0; n < inputs; ++n)
  {
    std::mt19937_64 random(seed * 0x9E3779B97F4A7C15u + n);
    const Bytes& one = corpus.at(random() % corpus.size());
    const Bytes input = sono::fuzz::mutated(one, corpus.at(random() % corpus.size()), random);
    setitimer(ITIMER_PROF, &longest, nullptr);
    LLVMFuzzerTestOneInput(input.data(), input.size());
  }
  fs::remove_all(sono::fuzz::workFolder());
  std::printf("%s: %zu files and %llu mutations of them were read.\n", argv[2], corpus.size(),
              static_cast<unsigned long long>(inputs));
}
