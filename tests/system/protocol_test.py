"""The API description is the server's law: every path of it answers as described, and nothing else answers."""
import concurrent.futures
import contextlib
import dataclasses
import gzip
import json
import os
import pathlib
import re
import shutil
import socket
import sqlite3
import tempfile
import time
import unittest
import urllib.parse

import jsonschema
import yaml
import zstandard

import commands
from commands import MAPPER, SERVER, STREET, Server, run

METHODS = ("get", "put", "post", "delete", "options", "head", "patch", "trace")  # that a description can have
OTHER_METHODS = ("PUT", "POST", "DELETE", "PATCH", "TRACE", "PROPFIND", "get")
EVERY_PATH = "x-every-path"  # in the description: what every path may answer
OPTIONS = "x-options"  # what it answers to OPTIONS
# Fields of any answer, which the description leaves to RFC 9110.
COMMON_FIELDS = {"server", "date", "content-length", "content-type", "connection"}
FOOTPRINT = {"type": "Polygon",
             "coordinates": [[[8.4, 49.0], [8.4001, 49.0], [8.4001, 49.0001], [8.4, 49.0001], [8.4, 49.0]]]}
NOWHERE = "0" * 32  # a well-formed digest of nothing


# == A client that sends what it is told to, and hides nothing.

@dataclasses.dataclass
class Request:
    url: str  # of the server
    target: str
    method: str = "GET"
    fields: dict = dataclasses.field(default_factory=dict)
    sent: bytes = None  # instead of all the above
    patience: int = 1  # times of asking, as long as no byte comes

    def bytes(self):
        lines = [f"{self.method} {self.target} HTTP/1.1", "Host: test", "Connection: close"]
        lines += [f"{name}: {value}" for name, value in self.fields.items()]
        return self.sent if self.sent is not None else "\r\n".join([*lines, "", ""]).encode()

    def __str__(self):
        return f"{self.method} {self.target} {self.fields or ''}"


@dataclasses.dataclass
class Answer:
    status: int
    fields: dict  # by their names in small letters
    body: bytes

    def lasting(self):
        """What is the same at every time of asking."""
        return self.status, {name: value for name, value in self.fields.items() if name != "date"}, self.body


def received_from(request):
    parts = urllib.parse.urlsplit(request.url)
    with socket.create_connection((parts.hostname, parts.port), timeout=30) as connection:
        connection.sendall(request.bytes())
        received = b""
        while more := connection.recv(65536):
            received += more
    return received


def answer_to(request):
    received = b""
    for _ in range(request.patience):
        received = received_from(request)
        if received:
            break
        time.sleep(0.05)
    head, _, body = received.partition(b"\r\n\r\n")
    first, *lines = head.decode("latin-1").split("\r\n")
    fields = {}
    for line in lines:
        name, value = line.split(": ", 1)
        assert name.lower() not in fields, f"{name} is there twice"
        fields[name.lower()] = value
    return Answer(int(first.split(" ")[1]), fields, body)


# == The description.

def resolved(description, part):
    """The part with what it refers to in its place."""
    if isinstance(part, list):
        return [resolved(description, each) for each in part]
    if not isinstance(part, dict):
        return part
    if "$ref" in part:
        target = description
        for word in part["$ref"].removeprefix("#/").split("/"):
            target = target[word]
        part = {**target, **{key: value for key, value in part.items() if key != "$ref"}}
    return {key: resolved(description, value) for key, value in part.items()}


def closed(schema, is_part=False):
    """The schema without keys that it does not name: clients ignore such, but the server sends none."""
    if isinstance(schema, list):
        return [closed(each) for each in schema]
    if not isinstance(schema, dict):
        return schema
    changed = {key: [closed(each, True) for each in value] if key == "allOf" else closed(value)
               for key, value in schema.items()}
    if isinstance(schema.get("properties"), dict) and not is_part:
        changed["unevaluatedProperties"] = False
    return changed


@dataclasses.dataclass
class Operation:
    path: str
    method: str
    parameters: list
    answers: dict  # status -> what is described

    def named(self, place):
        return [parameter["name"] for parameter in self.parameters if parameter["in"] == place]


class Description:
    def __init__(self, text):
        self.content = resolved(*[yaml.safe_load(text)] * 2)
        self.paths = list(self.content["paths"])
        self.every_path = self.statuses(self.content[EVERY_PATH])
        self.options = self.statuses(self.content[OPTIONS])
        self.operations = [self.operation(path, method, item) for path, item in self.content["paths"].items()
                           for method in METHODS if method in item]

    @staticmethod
    def statuses(responses):
        return {int(status): response for status, response in responses.items()}

    def operation(self, path, method, item):
        return Operation(path, method, item.get("parameters", []) + item[method].get("parameters", []),
                         self.statuses(item[method]["responses"]))

    def methods(self, path):
        """As the server names them in Allow."""
        return {operation.method.upper() for operation in self.operations if operation.path == path} | {"HEAD", "OPTIONS"}

    def path_of(self, target):
        """The described path that a target fits, if any."""
        words = [urllib.parse.unquote(word) for word in target.split("?")[0].split("/")]
        return next((path for path in self.paths if self.fits(path.split("/"), words)), None)

    @staticmethod
    def fits(pattern, words):
        return len(pattern) == len(words) and all(
            word != "" if part.startswith("{") else word == part for part, word in zip(pattern, words))


# == The maps and the servers.

def scribble(file, where):
    """Changes the bytes of the tiles, the cells and the record of the mapping that fit an SQL condition."""
    with contextlib.closing(sqlite3.connect(file)) as database:
        database.execute("UPDATE frames SET frame = zeroblob(length(frame)) WHERE " + where)
        database.execute("UPDATE meta SET value = '{}' WHERE key = 'mapping'")
        database.commit()


class World:
    """Servers over maps of every kind, and the names that paths need.

    street: a map of a street with walls, signed, with an older build.   yard: of walls alone, unsigned, without a record.
    spoilt: its file became unreadable while it was served, and its documents are no longer in memory.
    damaged: only its tiles, cells and record are, and so is its signature.
    """

    def __init__(self, folder, stack):
        def done(*words):
            result = run(*words)
            assert result.returncode == 0, result.stderr

        footprint = folder / "footprint.geojson"
        footprint.write_text(json.dumps(FOOTPRINT))
        maps, new = folder / "maps", folder / "new"
        maps.mkdir()
        new.mkdir()
        done(MAPPER, "build", "--drive", STREET / "street-map", "--map", maps / "street.map")
        done(MAPPER, "aerial", "--map", maps / "yard.map", "--footprints", footprint)
        shutil.copy(maps / "street.map", new)
        done(MAPPER, "aerial", "--map", new / "street.map", "--footprints", footprint)
        done(SERVER, "install", "--maps", maps, new / "street.map")
        done(SERVER, "keygen", "--out", folder / "key")
        done(SERVER, "sign", "--key", folder / "key", maps / "street.map")
        older = next((maps / ".builds" / "street").glob("*.map")).stem

        bad = folder / "bad"
        bad.mkdir()
        shutil.copy(new / "street.map", bad / "a-spoilt.map")
        shutil.copy(new / "street.map", bad / "z-damaged.map")
        scribble(bad / "z-damaged.map", "true")
        (bad / "z-damaged.map.sig").write_text("a shopping list\n")
        for number in range(300):  # more than stay in memory
            os.link(maps / "yard.map", bad / f"m{number}.map")
        (bad / "left-out.map").write_text("a shopping list\n")

        self.url = stack.enter_context(Server(maps)).url
        self.bad = stack.enter_context(Server(bad, "--ready-needs-all")).url
        done(SERVER, "token", "--tokens", folder / "tokens.json", "--add", "all", "--all-maps")  # any
        self.tokens = {name: run(SERVER, "token", "--tokens", folder / "tokens.json", "--add", name, *maps).stdout.strip()
                       for name, maps in (("operator", ["--all-maps"]), ("street", ["--map", "street"]), ("other", ["--map", "other"]))}
        self.guarded = stack.enter_context(Server(maps, "--tokens", folder / "tokens.json")).url
        self.limited = stack.enter_context(Server(maps, "--requests-per-s", "0.001", "--burst", "1")).url
        answer_to(Request(self.limited, "/healthz"))
        self.hasty = stack.enter_context(Server(maps, "--request-s", "1")).url
        self.full = stack.enter_context(Server(maps, "--connections", "1", "--request-s", "600")).url
        for number in range(300):
            answer_to(Request(self.bad, f"/v1/maps/m{number}"))
        with open(bad / "a-spoilt.map", "r+b") as file:
            file.truncate(5000)
        parts = urllib.parse.urlsplit(self.full)
        busy = stack.enter_context(socket.create_connection((parts.hostname, parts.port)))
        busy.sendall(b"GET /healthz HTTP/1.1\r\n")

        self.names = {"map": "street", "build": self.json("/v1/maps/street")["build"], "from": older}
        self.names["segment"] = self.json("/v1/maps/street")["segments"][0]
        root = f"/v1/maps/street/builds/{self.names['build']}"
        segment = self.json(f"{root}/segments/{self.names['segment']}")
        self.names["index"] = segment["tiles"]["tracklets"][0]["index"]
        self.names["cell"] = self.json(root + "/areas")["cells"]["walls"][0]["cell"]
        page = answer_to(Request(self.url, "/")).body.decode()
        self.names["release"], self.names["file"] = re.search(r"/?viewer/(\w{32})/([\w.]+\.js)", page).groups()
        latitude, longitude = segment["line"][0][:2]
        self.names |= {"near": f"{latitude},{longitude}", "radius_m": 50, "from_m": 0, "to_m": "inf",
                       "bbox": "8,48.9,8.5,49.1"}
        self.damaged = {"map": "z-damaged"}
        self.spoilt = {"map": "a-spoilt"}

    def json(self, target):
        return json.loads(answer_to(Request(self.url, target)).body)

    def value(self, operation, name):
        if name == "layer":
            return "walls" if "/areas" in operation.path else "tracklets"
        return str(self.names[name])

    def target(self, operation, without=(), **other):
        """The target of what there is, with other values for some parameters."""
        def value(name):
            return urllib.parse.quote(other.get(name, self.value(operation, name)), safe=",")

        path = re.sub(r"\{(\w+)\}", lambda brace: value(brace[1]), operation.path)
        query = "&".join(f"{name}={value(name)}" for name in operation.named("query") if name not in without)
        return path + ("?" + query if query else "")


# == How each status is provoked.

def as_described(world, operation):
    yield Request(world.url, world.target(operation), operation.method.upper())


def with_its_entity_tag(world, operation):
    for request in as_described(world, operation):
        request.fields["If-None-Match"] = answer_to(request).fields["etag"]
        yield request


def in_a_coding(world, operation):
    """As described, with and without a coding, and to who has a token."""
    for request in as_described(world, operation):
        yield request
        for coding in ("gzip", "zstd"):
            yield dataclasses.replace(request, fields={"Accept-Encoding": coding})
        yield dataclasses.replace(request, url=world.guarded, fields=bearing(world.tokens["operator"]))


def bearing(token):
    return {"Authorization": f"Bearer {token}"}


def without_a_token(world, operation):
    for fields in ({}, {"Authorization": "Basic dTpw"}, bearing("mp_unknown")):
        yield Request(world.guarded, world.target(operation), fields=fields)


def with_a_token_for_something_else(world, operation):
    yield Request(world.guarded, world.target(operation), fields=bearing(world.tokens["other"]))


def in_part(world, operation):
    for asked in ("bytes=0-0", "bytes=1-", "bytes=-2"):
        yield Request(world.url, world.target(operation), fields={"Range": asked})


def beyond_the_end(world, operation):
    yield Request(world.url, world.target(operation), fields={"Range": "bytes=100000000-"})


def once_too_often(world, operation):
    yield Request(world.limited, world.target(operation))


def malformed(world, operation):
    target = world.target(operation)
    joint = "&" if "?" in target else "?"
    yield Request(world.url, target + joint + "other=1")
    yield Request(world.url, target + joint + "=")
    for name in operation.named("query"):
        yield Request(world.url, world.target(operation, without=[name]))
        yield Request(world.url, target + f"&{name}={world.value(operation, name)}")
        for value in ("", ",", "x y"):
            yield Request(world.url, world.target(operation, **{name: value}))
    wrong = {"map": (".hidden", "a b", "x" * 65), "build": ("0" * 31, "G" * 32, "A" * 32), "segment": (".x", "a+b"),
             "layer": (".x", "a:b"), "index": ("00", "-1", "1.0", "4294967296", "x"), "cell": ("00", "-1", "x", "4294967296")}
    for name in operation.named("path"):
        for value in wrong.get(name, ()):
            yield Request(world.url, world.target(operation, **{name: value}))


def absent(world, operation):
    other = {"map": "village", "segment": "s", "layer": "l", "index": "4294967295", "cell": "1", "release": NOWHERE,
             "file": "other.js"}
    for name in operation.named("path"):
        if name in other:
            yield Request(world.url, world.target(operation, **{name: other[name]}))


def absent_in_the_yard(world, operation):
    yield from absent(world, operation)
    build = world.json("/v1/maps/yard")["build"]
    yield Request(world.url, world.target(operation, map="yard", build=build))


def gone(world, operation):
    yield Request(world.url, world.target(operation, build=NOWHERE))


def gone_since_long(world, operation):
    yield Request(world.url, world.target(operation, **{"from": NOWHERE}))


def unreadable(world, operation):
    yield Request(world.bad, world.target(operation, **world.spoilt))


def unreadable_in_part(world, operation):
    yield from unreadable(world, operation)
    yield Request(world.bad, world.target(operation, **world.damaged))


def not_ready(world, operation):
    yield Request(world.bad, world.target(operation))


def by_other_methods(world, operation):
    described = {each.method.upper() for each in world.description.operations if each.path == operation.path}
    for method in OTHER_METHODS:
        if method not in described:
            yield Request(world.url, world.target(operation), method)


def never_ending(world, operation):
    request = Request(world.hasty, world.target(operation))
    request.sent = request.bytes()[:-2]
    yield request


def with_a_long_body(world, operation):
    yield Request(world.url, world.target(operation), fields={"Content-Length": 100_000})


def with_a_long_line(world, operation):
    target = world.target(operation)
    yield Request(world.url, target + ("&" if "?" in target else "?") + "other=" + "1" * 5000)


def with_a_long_header(world, operation):
    yield Request(world.url, world.target(operation), fields={"Other": "1" * 20_000})


def to_a_full_server(world, operation):
    # It answers without reading; one that comes while another is told so may be closed without an answer.
    yield Request(world.full, world.target(operation), sent=b"", patience=100)


# By status and path, or status and method, or status. Each yields requests that must all be answered so.
WAYS = {
    200: in_a_coding,
    206: in_part,
    304: with_its_entity_tag,
    400: malformed,
    401: without_a_token,
    403: with_a_token_for_something_else,
    404: absent,
    (404, "/v1/maps/{map}/builds/{build}/manifest.sig"): absent_in_the_yard,
    (404, "/v1/maps/{map}/builds/{build}/mapping"): absent_in_the_yard,
    405: by_other_methods,
    408: never_ending,
    410: gone,
    (410, "/v1/maps/{map}/changes"): gone_since_long,
    413: with_a_long_body,
    414: with_a_long_line,
    416: beyond_the_end,
    429: once_too_often,
    431: with_a_long_header,
    500: unreadable,
    (500, "/v1/maps/{map}/builds/{build}/manifest.sig"): unreadable_in_part,
    (500, "/v1/maps/{map}/builds/{build}/mapping"): unreadable_in_part,
    (500, "/v1/maps/{map}/builds/{build}/segments/{segment}/tiles"): unreadable_in_part,
    (500, "/v1/maps/{map}/builds/{build}/segments/{segment}/tiles/{layer}/{index}"): unreadable_in_part,
    (500, "/v1/maps/{map}/builds/{build}/areas/{layer}"): unreadable_in_part,
    (500, "/v1/maps/{map}/builds/{build}/areas/{layer}/{cell}"): unreadable_in_part,
    (500, "/viewer/maps/{map}/builds/{build}/segments/{segment}/landmarks/{index}"): unreadable_in_part,
    (500, "/viewer/maps/{map}/builds/{build}/walls/{cell}"): unreadable_in_part,
    503: to_a_full_server,
    (503, "/readyz"): not_ready,
}
# Answered before the request was read, so that it is unknown whether it is a HEAD.
UNREAD = (408, 414, 431, 503)
IN_PART = (206, 416)  # only GET asks for parts (RFC 9110, section 14.2)


def way_to(status, operation):
    return next((WAYS[key] for key in ((status, operation.path), (status, operation.method), status) if key in WAYS), None)


class Protocol(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with contextlib.ExitStack() as stack:
            folder = stack.enter_context(tempfile.TemporaryDirectory())
            cls.world = World(pathlib.Path(folder), stack)
            cls.description = Description(answer_to(Request(cls.world.url, "/openapi.yaml")).body)
            cls.world.description = cls.description
            cls.addClassCleanup(stack.pop_all().close)

    def expect_answered(self, operation, status, described):
        """What is described as an answer of a path comes when it is provoked."""
        with self.subTest(path=operation.path, method=operation.method, status=status):
            way = way_to(status, operation)
            self.assertIsNotNone(way, "no way is known to provoke this; add one to WAYS")
            requests = list(way(self.world, operation))
            self.assertTrue(requests, f"{way.__name__} asks for nothing here")
            self.expect_each_answered(operation, requests, status, described)

    def expect_each_answered(self, operation, requests, status, described):
        for request in requests:
            with self.subTest(request=str(request)[:200], status=status):
                answer = answer_to(request)
                self.expect_described(answer, status, described)
                if request.method == "GET" and status not in (*UNREAD, *IN_PART):
                    self.expect_same_by_head(request, answer)
                if status == 405:
                    self.assertEqual(set(answer.fields["allow"].split(", ")), self.description.methods(operation.path))

    def expect_described(self, answer, status, described):
        self.assertEqual(answer.status, status, answer.body[:500])
        headers = described.get("headers", {})
        for name, header in headers.items():
            if name.lower() not in answer.fields and not header.get("required", True):
                continue
            self.assertIn(name.lower(), answer.fields)
            jsonschema.validate(answer.fields[name.lower()], header["schema"])
        self.assertLessEqual(set(answer.fields), {name.lower() for name in headers} | COMMON_FIELDS, "not described")
        content = described.get("content", {})
        if not content:
            self.assertEqual(answer.body, b"")
            self.assertNotIn("content-type", answer.fields)
            self.assertEqual(answer.fields.get("content-length", "0"), "0")
            return
        self.assertEqual(int(answer.fields["content-length"]), len(answer.body))
        kind = answer.fields["content-type"].split(";")[0]
        self.assertIn(kind, content)
        if "schema" in content[kind]:
            text = decoded(answer).decode()
            value = json.loads(text) if kind.endswith("json") else text
            jsonschema.Draft202012Validator(closed(content[kind]["schema"])).validate(value)
        if kind == "application/problem+json":
            self.assertEqual(json.loads(answer.body)["status"], status)

    def expect_same_by_head(self, request, answer):
        _, fields, _ = answer.lasting()
        head = answer_to(dataclasses.replace(request, method="HEAD"))
        if request.target == "/metrics":  # it has counted itself since
            fields = {**fields, "content-length": head.fields["content-length"]}
        self.assertEqual(head.lasting(), (answer.status, fields, b""))

    def test_the_description_is_sound(self):
        for operation in self.description.operations:
            with self.subTest(path=operation.path):
                self.assertEqual(operation.named("path"), re.findall(r"\{(\w+)\}", operation.path))
                self.assertIn(200, operation.answers if operation.method == "get" else [200])
        for name, schema in self.description.content["components"]["schemas"].items():
            with self.subTest(schema=name):
                jsonschema.Draft202012Validator.check_schema(schema)

    def test_every_path_answers_as_described(self):
        for operation in self.description.operations:
            for status, described in operation.answers.items():
                self.expect_answered(operation, status, described)

    def test_what_every_path_may_answer(self):
        operations = [operation for operation in self.description.operations if operation.method == "get"]
        for status, described in self.description.every_path.items():
            threads = len(operations) if status == 408 else 1  # each takes a second
            with concurrent.futures.ThreadPoolExecutor(threads) as together:
                for done in [together.submit(self.expect_answered, operation, status, described)
                             for operation in operations if status not in operation.answers]:
                    done.result()

    def test_every_path_tells_its_methods(self):
        for target in ["*", *(self.world.target(operation) for operation in self.description.operations)]:
            for url in (self.world.url, self.world.guarded):
                with self.subTest(target=target):
                    for status, described in self.description.options.items():
                        self.expect_described(answer_to(Request(url, target, "OPTIONS")), status, described)

    def test_a_token_for_a_map_is_for_all_of_it(self):
        for operation in self.description.operations:
            with self.subTest(path=operation.path):
                asked = Request(self.world.guarded, self.world.target(operation), fields=bearing(self.world.tokens["street"]))
                self.assertEqual(answer_to(asked).status, 403 if operation.path == "/metrics" else 200)

    def test_nothing_else_answers(self):
        targets = {"*", "/v1", "/v1/", "/v2/maps", "/index.html", "/favicon.ico", "/robots.txt", "/.well-known/security.txt",
                   "/openapi.json", "/openapi.yml", "/v1/openapi.yaml", "/viewer", "/viewer/", "/v1/maps/street/builds"}
        for operation in self.description.operations:
            targets |= set(neighbours(self.world.target(operation)))
        for target in sorted(targets):
            if self.description.path_of(target) is None:
                with self.subTest(target=target):
                    answer = answer_to(Request(self.world.url, target))
                    self.assertIn(answer.status, (400, 404), answer.body[:300])
                    self.expect_described(answer, answer.status, self.description.content["components"]["responses"]["Wrong"])

    def test_what_has_no_meaning_in_a_path(self):
        for operation in self.description.operations:
            target = self.world.target(operation)
            path, mark, query = target.partition("?")
            for wrong in ("%", "%4", "%zz", "%00", "%0a", "/.", "/..", "/%2e%2e", "/%2E"):
                with self.subTest(target=path + wrong):
                    answer = answer_to(Request(self.world.url, path + wrong + mark + query))
                    self.assertEqual(answer.status, 400)

    def test_a_percent_encoded_letter_is_the_letter(self):
        for operation in self.description.operations:
            target = self.world.target(operation)
            if len(target) == 1 or operation.path == "/metrics":
                continue
            for form in ("%{:02x}", "%{:02X}"):
                encoded = target.replace(target[1:3], target[1] + form.format(ord(target[2])), 1)
                with self.subTest(target=encoded):
                    self.assertEqual(answer_to(Request(self.world.url, encoded, operation.method.upper())).lasting(),
                                     answer_to(Request(self.world.url, target, operation.method.upper())).lasting())

    def test_a_target_may_name_the_host(self):
        for operation in self.description.operations:
            target = self.world.target(operation)
            with self.subTest(target=target):
                answer = answer_to(Request(self.world.url, self.world.url + target, operation.method.upper()))
                self.assertIn(answer.status, operation.answers)
                self.assertLess(answer.status, 300)

    def test_the_paths_are_those_that_are_counted(self):
        for operation in self.description.operations:
            answer_to(Request(self.world.url, self.world.target(operation), operation.method.upper()))
        answer_to(Request(self.world.url, "/nothing/here"))
        text = answer_to(Request(self.world.url, "/metrics")).body.decode()
        counted = set(re.findall(r'^milepost_http_requests_total\{route="([^"]*)"', text, re.MULTILINE))
        self.assertEqual(counted, set(self.description.paths) | {"other"})


def decoded(answer):
    """The body without its coding."""
    coding = answer.fields.get("content-encoding")
    if coding == "gzip":
        return gzip.decompress(answer.body)
    return zstandard.ZstdDecompressor().decompress(answer.body) if coding == "zstd" else answer.body


def neighbours(target):
    """Targets one step from a target."""
    path, mark, query = target.partition("?")
    words = path.split("/")[1:]

    def joined(changed):
        return "/" + "/".join(changed) + mark + query

    yield joined([*words, ""])
    yield joined([*words, "more"])
    yield joined(words[:-1] or ["more"])
    yield "/" + joined(words)
    for at, word in enumerate(words):
        before, after = words[:at], words[at + 1:]
        yield joined([*before, "", word, *after])
        yield joined([*before, *after])
        for other in (word.upper(), word.capitalize(), word + "s", word[:-1], word + ".json", word + ";v=1", word + "%20",
                      "v2" if word == "v1" else word):
            yield joined([*before, other, *after])
        if after:
            yield joined([*before, word + "%2F" + after[0], *after[1:]])


if __name__ == "__main__":
    commands.main()
