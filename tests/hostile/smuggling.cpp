#include "tests/hostile/requests.h"

namespace pmesh::testing {
namespace {

using Strings = std::vector<std::string>;

const std::string kHidden =
    "GET /" + std::string(kHiddenId) + " HTTP/1.1\r\nHost: localhost\r\nX: y\r\n\r\n";

/// A line with its control characters spelled out, for names.
std::string printable(const std::string& text) {
  constexpr char kHex[] = "0123456789abcdef";
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7f) {
      result += c;
    } else {
      result += {'\\', 'x', kHex[byte >> 4], kHex[byte & 15]};
    }
  }
  return result;
}

/// A request with these header lines, each with its end, and what follows the header.
HostileRequest request(const std::string& method, const std::string& lines,
                       const std::string& rest) {
  return {method + " " + printable(lines) + " | " + printable(rest.substr(0, 12)),
          method + " /catalog HTTP/1.1\r\nHost: localhost\r\n" + lines + "\r\n" + rest};
}

/// All spellings of Transfer-Encoding that somebody takes for chunked and somebody else does not.
Strings transfer_encodings() {
  Strings lines;
  for (const char* value : {"chunked",
                            "Chunked",
                            "CHUNKED",
                            "xchunked",
                            "chunked1",
                            "chunked, identity",
                            "identity, chunked",
                            "gzip, chunked",
                            "chunked, gzip",
                            "chunked, chunked",
                            "identity",
                            ", chunked",
                            "chunked,",
                            "\"chunked\"",
                            "chunked;q=1",
                            "chunked\t",
                            "\tchunked",
                            "\x0b"
                            "chunked",
                            "chunked\x0b",
                            "\x0c"
                            "chunked",
                            "chu\x01nked",
                            "\xa0"
                            "chunked",
                            "c hunked",
                            ""}) {
    lines.push_back(std::string("Transfer-Encoding: ") + value + "\r\n");
  }
  lines.push_back(std::string("Transfer-Encoding: chunked\0\r\n", 29));
  for (const char* line :
       {"Transfer-Encoding:chunked\r\n", "Transfer-Encoding : chunked\r\n",
        "Transfer-Encoding\t: chunked\r\n", " Transfer-Encoding: chunked\r\n",
        "\tTransfer-Encoding: chunked\r\n", "X: y\n Transfer-Encoding: chunked\r\n",
        "X: y\nTransfer-Encoding: chunked\r\n", "X: y\rTransfer-Encoding: chunked\r\n",
        "Transfer-Encoding:\r\n chunked\r\n", "Transfer-Encoding:\n chunked\r\n",
        "transfer-encoding: chunked\r\n", "TRANSFER-ENCODING: chunked\r\n",
        "Transfer-Encoding: chunked\r\nTransfer-Encoding: identity\r\n",
        "Transfer-Encoding: identity\r\nTransfer-Encoding: chunked\r\n",
        "Transfer-Encoding: chunked\n", "Transfer-Encoding: chunked\r"}) {
    lines.push_back(line);
  }
  return lines;
}

void add_transfer_encodings(std::vector<HostileRequest>& all) {
  const std::string chunked = "0\r\n\r\n" + kHidden;
  const std::string whole = "Content-Length: " + std::to_string(chunked.size()) + "\r\n";
  for (const std::string& line : transfer_encodings()) {
    for (const char* method : {"GET", "POST"}) {
      all.push_back(request(method, whole + line, chunked));                              // CL.TE
      all.push_back(request(method, line + "Content-Length: 3\r\n", "8\r\n" + kHidden));  // TE.CL
      all.push_back(request(method, "Content-Length: 0\r\n" + line, kHidden));
    }
    all.push_back(request("POST", line, chunked));
  }
}

/// Lengths that some read as `length`, some as nothing, some as something else.
Strings odd_lengths(const std::string& length) {
  Strings values = {"",
                    "-0",
                    "x",
                    "4294967296",
                    "18446744073709551616",
                    "18446744073709551617",
                    "99999999999999999999999999"};
  for (const char* before :
       {"+", "-", "0x", "0,", "0 ", "00", "00000000000000000", "\x0b", "\xb2"}) {
    values.push_back(before + length);
  }
  for (const char* behind : {".0", "e0", ",0", " 0", ";", "\x0b", "\x0c"}) {
    values.push_back(length + behind);
  }
  const std::string zero(1, '\0');
  for (const std::string& value :
       {length + ", " + length, '"' + length + '"', length + zero, zero + length}) {
    values.push_back(value);
  }
  return values;
}

void add_lengths(std::vector<HostileRequest>& all) {
  const std::string length = std::to_string(kHidden.size());
  for (const std::string& value : odd_lengths(length)) {
    for (const char* method : {"GET", "POST"}) {
      all.push_back(request(method, "Content-Length: " + value + "\r\n", kHidden));
    }
  }
  const std::string name = "Content-Length";
  for (const std::string& lines :
       {name + ": " + length + "\r\n", name + ":" + length + "\r\n",
        name + ": 0\r\n" + name + ": " + length + "\r\n",
        name + ": " + length + "\r\n" + name + ": 0\r\n",
        name + ": " + length + "\r\n" + name + ": " + length + "\r\n",
        name + ": 0\r\n" + name + ": 0\r\n", name + " : " + length + "\r\n",
        name + "\t: " + length + "\r\n", " " + name + ": " + length + "\r\n",
        "X: y\r\n " + name + ": " + length + "\r\n", name + ":\r\n " + length + "\r\n",
        name + ": 0\r\n " + length + "\r\n", "X: y\n" + name + ": " + length + "\r\n",
        "X: y\r" + name + ": " + length + "\r\n", name + ": " + length + "\n",
        "CONTENT-LENGTH: " + length + "\r\n",
        "Expect: 100-continue\r\n" + name + ": " + length + "\r\n",
        "Connection: Content-Length\r\n" + name + ": " + length + "\r\n"}) {
    for (const char* method : {"GET", "POST", "HEAD", "OPTIONS"}) {
      all.push_back(request(method, lines, kHidden));
    }
  }
}

void add_chunk_sizes(std::vector<HostileRequest>& all) {
  for (const char* size :
       {"00000000000000000", "0000000000000000f", "10000000000000000", "fffffffffffffffff", "0x0",
        "-1", "+0", "0 ", " 0", "0;x=y", "0;x=\"\r\n", "0\t", "g", "", "0\n", "0\r", "0,0"}) {
    all.push_back(request("POST", "Transfer-Encoding: chunked\r\n",
                          std::string(size) + "\r\n\r\n" + kHidden));
  }
}

/// What is wrong here is the header itself: a reader who passes over it takes the next request for
/// one of its own.
void add_headers(std::vector<HostileRequest>& all) {
  for (const char* line : {"GET  /catalog HTTP/1.1",
                           "GET /catalog  HTTP/1.1",
                           "GET\t/catalog HTTP/1.1",
                           "GET /catalog\tHTTP/1.1",
                           " GET /catalog HTTP/1.1",
                           "GET /catalog HTTP/1.1 ",
                           "GET /catalog",
                           "GET /catalog HTTP/0.9",
                           "GET /catalog HTTP/2.0",
                           "GET /catalog HTTP/1.2",
                           "GET /catalog HTTP/1.10",
                           "GET /catalog HTTP/01.1",
                           "GET /catalog HTTP/1",
                           "GET /catalog HTTP/1.",
                           "GET /catalog http/1.1",
                           "GET /catalog HTTP /1.1",
                           "GET /catalog HTTPS/1.1",
                           "GET /catalog HTTP/1.1 HTTP/1.1",
                           "GET /cata log HTTP/1.1",
                           "GET /catalog\x0bHTTP/1.1",
                           "G\x01T /catalog HTTP/1.1",
                           "G(T /catalog HTTP/1.1",
                           " /catalog HTTP/1.1",
                           "GET HTTP/1.1",
                           "GET /cat\x7f"
                           "alog HTTP/1.1",
                           "GET /catalog\xff HTTP/1.1",
                           "PRI * HTTP/2.0",
                           "GET /catalog HTTP/1.1\r",
                           "GET /catalog\r HTTP/1.1",
                           "GET /catalog HTTP/-1.1"}) {
    all.push_back({printable(line), std::string(line) + "\r\nHost: localhost\r\n\r\n" + kHidden});
  }
  for (const char* host : {"local host", "localhost/catalog", "user@localhost",
                           "localhost, elsewhere", "localhost:80:80", "localhost:x", "localhost#",
                           "localhost?x", "::1", "[::1", "[]", "[::1]elsewhere", "[::1%25lo]",
                           "\"localhost\"", "a\\b", "loc\xc3\xa4lhost", "<localhost>"}) {
    all.push_back({std::string("Host ") + printable(host),
                   std::string("GET /catalog HTTP/1.1\r\nHost: ") + host + "\r\n\r\n" + kHidden});
  }
  Strings lines = {"Host: localhost\r\n",
                   "host: elsewhere\r\n",
                   "X y\r\n",
                   ": y\r\n",
                   "X : y\r\n",
                   "X\t: y\r\n",
                   " X: y\r\n",
                   "X: y\r\n z\r\n",
                   "X: y\r\n\tz\r\n",
                   "X\x01: y\r\n",
                   "X(: y\r\n",
                   "X\xff: y\r\n",
                   "X: \x01\r\n",
                   "X: \x7f\r\n",
                   "X: \x1b\r\n",
                   "X: y\rZ: z\r\n",
                   "X: y\n",
                   "X: y\r",
                   "X: y\n\n",
                   "X: y\r\r\n",
                   "\n",
                   "\r"};
  lines.push_back(std::string("X: \0\r\n", 6));
  lines.push_back(std::string("X\0: y\r\n", 7));
  for (const std::string& line : lines) all.push_back(request("GET", line, kHidden));
  for (const char* head :
       {"GET /catalog HTTP/1.1\n\n", "GET /catalog HTTP/1.1\nHost: localhost\n\n",
        "GET /catalog HTTP/1.1\r\nHost: localhost\n\n", "GET /catalog HTTP/1.1\r\n\r\n",
        "GET /catalog HTTP/1.1\nHost: localhost\r\n\r\n",
        "GET /catalog HTTP/1.1\r\n Host: localhost\r\n\r\n",
        "GET /catalog HTTP/1.1\rHost: localhost\r\r"}) {
    all.push_back({printable(head), head + kHidden});
  }
}

}  // namespace

std::vector<HostileRequest> smuggling_requests() {
  std::vector<HostileRequest> all;
  add_transfer_encodings(all);
  add_lengths(all);
  add_chunk_sizes(all);
  add_headers(all);
  return all;
}

std::vector<HostileRequest> odd_requests() {
  std::vector<HostileRequest> all;
  const std::string end = "\r\nConnection: close\r\n\r\n";
  for (const char* head :
       {"\r\nGET /catalog HTTP/1.1\r\nHost: localhost",
        "GET /catalog HTTP/1.1\r\nHost:",
        "GET /catalog HTTP/1.1\r\nHost: [2001:db8::1]:80",
        "GET /catalog HTTP/1.1\r\nHost: localhost\r\nRange: bytes=0-1\r\nRange: bytes=2-3",
        "GET /catalog HTTP/1.1\r\nhOST:\t localhost \t",
        "GET /catalog HTTP/1.0",
        "GET http://localhost/catalog HTTP/1.1\r\nHost: elsewhere",
        "GET http:///catalog HTTP/1.1\r\nHost: localhost",
        "GET * HTTP/1.1\r\nHost: localhost",
        "OPTIONS * HTTP/1.1\r\nHost: localhost",
        "CONNECT localhost:80 HTTP/1.1\r\nHost: localhost",
        "TRACE /catalog HTTP/1.1\r\nHost: localhost",
        "get /catalog HTTP/1.1\r\nHost: localhost",
        "GET /catalog#x HTTP/1.1\r\nHost: localhost",
        "GET catalog HTTP/1.1\r\nHost: localhost",
        "GET /catalog HTTP/1.1\r\nHost: localhost\r\nContent-Length: 0",
        "GET /catalog HTTP/1.1\r\nHost: localhost\r\nTE: trailers, chunked",
        "GET /catalog HTTP/1.1\r\nHost: localhost\r\nExpect: 100-continue",
        "GET /catalog HTTP/1.1\r\nHost: localhost\r\nUpgrade: h2c\r\nHTTP2-Settings: AAMAAABk",
        "GET /catalog HTTP/1.1\r\nHost: localhost\r\nTransfer_Encoding: chunked",
        "GET /catalog HTTP/1.1\r\nHost: localhost\r\nX-HTTP-Method-Override: DELETE",
        "GET /catalog HTTP/1.1\r\nHost: localhost\r\nX: \xc3\xa9"}) {
    all.push_back({printable(head), head + end});
  }
  return all;
}

}  // namespace pmesh::testing
