# Varnish 7 as a cache before pmesh. Only answers that pmesh calls immutable are kept; names
# (/catalog, /{id}) are `no-cache` and passed on, as Varnish's own rules have it, and so are requests
# with an Authorization field.
#   varnishd -a :80 -f varnish.vcl -s default,4g
# The storage must hold the largest file with room to spare: a range of a file that is not in the
# cache fetches all of it, and is answered as soon as its own bytes are there.
vcl 4.1;

backend pmesh {
  .host = "pmesh";
  .port = "8080";
  .connect_timeout = 2s;
  .first_byte_timeout = 60s;
  .between_bytes_timeout = 60s;
  .probe = {
    .url = "/health";
    .interval = 1s;
    .timeout = 1s;
    .window = 3;
    .threshold = 2;
  }
}

sub vcl_recv {
  # pmesh sets and reads no cookies, and never encodes an answer.
  unset req.http.Cookie;
  unset req.http.Accept-Encoding;
  if (req.http.Upgrade ~ "(?i)^websocket$") {
    return (pipe);
  }
}

sub vcl_pipe {
  set bereq.http.Upgrade = req.http.Upgrade;
  set bereq.http.Connection = req.http.Connection;
}

sub vcl_backend_response {
  # A slow client must not hold a fetch up, nor a fetch a client.
  set beresp.do_stream = true;
}

sub vcl_deliver {
  if (obj.hits > 0) {
    set resp.http.X-Cache = "HIT";
  } else {
    set resp.http.X-Cache = "MISS";
  }
}
