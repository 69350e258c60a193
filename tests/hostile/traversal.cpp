#include "tests/hostile/requests.h"

namespace pmesh::testing {

std::vector<std::string> traversal_targets() {
  const std::vector<std::string> dots = {
      "..",           "%2e%2e", ".%2e", "%252e%252e", "%c0%ae%c0%ae",      "%e0%80%ae%e0%80%ae",
      "%u002e%u002e", "..;",    "...",  "%2e%2e%00",  "%EF%BC%8E%EF%BC%8E"};
  const std::vector<std::string> slashes = {"/",      "%2f",       "%252f",    "\\",  "%5c",
                                            "%c0%af", "%e0%80%af", "~",        "%7e", "//",
                                            "/./",    "%u2215",    "%25%32%66"};
  const std::vector<std::string> ends = {"secret", "secret.pmesh", "secret.txt",
                                         "secret.txt%00.pmesh"};
  std::vector<std::string> targets;
  for (const std::string& dot : dots) {
    for (const std::string& slash : slashes) {
      const std::string up = dot + slash;
      targets.push_back("/" + up + ends[targets.size() % ends.size()]);
      targets.push_back("/mesh" + slash + up + up + ends[targets.size() % ends.size()]);
      targets.push_back("/folder~" + up + up + ends[targets.size() % ends.size()]);
    }
  }
  for (const char* start :
       {"/", "//", "/%2f", "/~", "/file:", "/file:///", "/.", "/%00", "/\\\\"}) {
    for (const char* rest :
         {"etc/passwd", "etc~passwd", "proc~self~environ", "secret", "..", "."}) {
      targets.push_back(std::string(start) + rest);
    }
  }
  return targets;
}

}  // namespace pmesh::testing
