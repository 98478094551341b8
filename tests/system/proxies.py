"""A proxy in front of a tile server, for tests of what goes wrong on the way."""
import contextlib
import http.server
import threading
import urllib.error
import urllib.request


@contextlib.contextmanager
def proxied(url, answers=lambda request: False, changed=lambda request, status, body: body):
    """A proxy in front of the server at `url`; yields it, with its own `url`. `answers` may respond instead, and then
    is true; `changed` gives the body that is sent on."""
    class Handler(http.server.BaseHTTPRequestHandler):
        protocol_version = "HTTP/1.1"

        def do_GET(self):
            if answers(self):
                return
            try:
                with urllib.request.urlopen(url + self.path) as answer:
                    status, header, body = answer.status, answer.headers, answer.read()
            except urllib.error.HTTPError as error:
                status, header, body = error.code, error.headers, error.read()
            body = changed(self, status, body)
            self.send_response(status)
            self.send_header("Content-Type", header["Content-Type"])
            self.send_header("Content-Length", str(len(body)))
            self.end_headers()
            self.wfile.write(body)

        def log_message(self, *_):
            pass

    class Proxy(http.server.ThreadingHTTPServer):
        daemon_threads = True
        block_on_close = False  # a response may hang

        def handle_error(self, *_):  # the client disconnected
            pass

    with Proxy(("127.0.0.1", 0), Handler) as proxy:
        proxy.url = f"http://127.0.0.1:{proxy.server_address[1]}"
        threading.Thread(target=proxy.serve_forever, daemon=True).start()
        yield proxy
        proxy.shutdown()
