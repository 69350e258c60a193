// The parts of server/http/http_answer.h that know no meshes: errors, and heads as text.
#include "server/http/http_answer.h"

namespace pmesh {
namespace {

constexpr std::string_view kExposed =
    "ETag, Content-Range, Content-Length, Accept-Ranges, Content-Location, PMesh-Faces, "
    "PMesh-Vertices, PMesh-Chunks, PMesh-Reached";

std::string_view reason_phrase(int status) {
  switch (status) {
    case 200:
      return "OK";
    case 204:
      return "No Content";
    case 206:
      return "Partial Content";
    case 304:
      return "Not Modified";
    case 400:
      return "Bad Request";
    case 401:
      return "Unauthorized";
    case 403:
      return "Forbidden";
    case 404:
      return "Not Found";
    case 405:
      return "Method Not Allowed";
    case 408:
      return "Request Timeout";
    case 413:
      return "Content Too Large";
    case 414:
      return "URI Too Long";
    case 416:
      return "Range Not Satisfiable";
    case 426:
      return "Upgrade Required";
    case 429:
      return "Too Many Requests";
    case 431:
      return "Request Header Fields Too Large";
    case 500:
      return "Internal Server Error";
    case 503:
      return "Service Unavailable";
    default:
      return "Error";
  }
}

}  // namespace

HttpAnswer error_answer(int status, std::string_view message) {
  HttpAnswer answer;
  answer.status = status;
  answer.fields.add("Content-Type", "text/plain; charset=utf-8");
  answer.fields.add("Cache-Control", "no-store");
  answer.text.append(message).append("\n");
  return answer;
}

HttpAnswer busy_answer(int status, std::string_view message) {
  HttpAnswer answer = error_answer(status, message);
  answer.fields.add("Retry-After", "1");
  return answer;
}

std::string head_text(const HttpAnswer& answer, std::string_view date, bool keep_alive) {
  std::string head;
  head.reserve(1024);
  head.append("HTTP/1.1 ").append(std::to_string(answer.status)).append(" ");
  head.append(reason_phrase(answer.status)).append("\r\nDate: ").append(date).append("\r\n");
  head.append("Access-Control-Allow-Origin: *\r\nAccess-Control-Expose-Headers: ");
  head.append(kExposed).append("\r\nX-Content-Type-Options: nosniff\r\n");
  head.append(answer.fields.lines());
  if (answer.may_have_body()) {
    head.append("Content-Length: ").append(std::to_string(answer.body_bytes())).append("\r\n");
  }
  head.append(keep_alive ? "Connection: keep-alive" : "Connection: close");
  head.append(answer.status == 426 ? ", upgrade\r\n\r\n" : "\r\n\r\n");
  return head;
}

}  // namespace pmesh
