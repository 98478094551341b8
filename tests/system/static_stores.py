"""Static web servers that serve a published tree, for tests: nginx as configured by deploy/nginx-static.conf, and one that
knows keys and no folders, as object stores do."""
import contextlib
import http.server
import pathlib
import re
import shutil
import socket
import subprocess
import threading
import time

NGINX = shutil.which("nginx", path="/usr/sbin:/usr/bin:/sbin:/bin")
CONFIGURATION = pathlib.Path(__file__).resolve().parents[2] / "deploy" / "nginx-static.conf"


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def wait_for(port, process):
    for _ in range(500):
        with socket.socket() as probe:
            if probe.connect_ex(("127.0.0.1", port)) == 0:
                return
        if process.poll() is not None:
            break
        time.sleep(0.02)
    raise RuntimeError("nginx does not listen")


@contextlib.contextmanager
def nginx(tree, folder):
    """nginx with its files in `folder`, an empty one; yields its URL."""
    port = free_port()
    site = re.sub(r"listen 8080", f"listen 127.0.0.1:{port}", CONFIGURATION.read_text(encoding="utf-8"))
    site = re.sub(r"root \S+;", f"root {tree};", site)
    temporary = "".join(f"{name}_temp_path {folder}/{name};\n"
                        for name in ("client_body", "proxy", "fastcgi", "uwsgi", "scgi"))
    file = folder / "nginx.conf"
    user = "user root;\n" if pathlib.Path("/proc/self").stat().st_uid == 0 else ""
    file.write_text(f"daemon off;\n{user}worker_processes 1;\npid {folder}/pid;\nerror_log {folder}/error.log;\n"
                    f"events {{}}\nhttp {{\naccess_log {folder}/access.log;\n{temporary}{site}}}\n", encoding="utf-8")
    with subprocess.Popen([NGINX, "-c", str(file), "-p", str(folder)], stderr=subprocess.DEVNULL) as process:
        try:
            wait_for(port, process)
            yield f"http://127.0.0.1:{port}"
        finally:
            process.terminate()


@contextlib.contextmanager
def object_store(tree):
    """A store of keys, which are the paths of the tree's files; yields its URL. What is no key is refused as S3 does."""
    class Handler(http.server.BaseHTTPRequestHandler):
        protocol_version = "HTTP/1.1"

        def do_GET(self):
            file = tree / self.path.split("?")[0].lstrip("/")
            there = file.is_file()
            body = file.read_bytes() if there else b"<Error><Code>AccessDenied</Code></Error>"
            self.send_response(200 if there else 403)
            self.send_header("Content-Type", "binary/octet-stream" if there else "application/xml")
            self.send_header("Content-Length", str(len(body)))
            self.end_headers()
            self.wfile.write(body)

        def log_message(self, *_):
            pass

    class Store(http.server.ThreadingHTTPServer):
        daemon_threads = True

    with Store(("127.0.0.1", 0), Handler) as store:
        threading.Thread(target=store.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{store.server_address[1]}"
        store.shutdown()
