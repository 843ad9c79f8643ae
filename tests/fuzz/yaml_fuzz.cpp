#include "base/yaml.hpp"
#include "tests/fuzz/fuzz_support.hpp"

using namespace roadbook;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fuzz::try_parse([&] {
    YamlMap yaml = YamlMap::parse(std::string(fuzz::text_of(data, size)), "x.yaml");
    double number = 0.0;
    int whole = 0;
    std::uint64_t seed = 0;
    bool flag = false;
    std::string word;
    std::optional<double> perhaps;
    std::vector<double> numbers;
    std::vector<std::string> words;
    std::vector<std::vector<double>> rows;
    for (const std::string& key : yaml.keys()) {
      yaml.read(key, number);
      yaml.read(key, whole);
      yaml.read(key, seed);
      yaml.read(key, flag);
      yaml.read(key, word);
      yaml.read(key, perhaps);
      yaml.read(key, numbers);
      yaml.read(key, words);
      yaml.read(key, rows);
      if (auto inner = yaml.map(key))
        for (const std::string& name : inner->keys()) inner->read(name, number);
      (void)yaml.maps(key);
    }
    yaml.finish();
  });
}
