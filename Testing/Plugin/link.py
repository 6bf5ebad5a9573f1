"""A link between a client and a pvserver that counts the bytes which cross it, each way. As a program, it passes them on: a client in
Python holds up all threads of its process while it waits."""
import mmap
import os
import pathlib
import shutil
import socket
import struct
import subprocess
import sys
import tempfile
import threading

PIECE = 1 << 20
COUNTS = struct.Struct("=QQ")  # from the server, to the server


def pass_on(source, sink, counts, which):
    passed = 0
    try:
        while piece := source.recv(PIECE):
            passed += len(piece)
            struct.pack_into("=Q", counts, 8 * which, passed)
            sink.sendall(piece)
        sink.shutdown(socket.SHUT_WR)
    except OSError:
        pass  # an end has left


def serve(server_port, path):
    """Of one client; says its port on the standard output."""
    with open(path, "r+b") as file:
        counts = mmap.mmap(file.fileno(), COUNTS.size)
    with socket.create_server(("127.0.0.1", 0)) as listener:
        print(listener.getsockname()[1], flush=True)
        client, _ = listener.accept()
    server = socket.create_connection(("127.0.0.1", server_port))
    for end in (client, server):
        end.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    ways = [threading.Thread(target=pass_on, args=way)
            for way in ((server, client, counts, 0), (client, server, counts, 1))]
    for way in ways:
        way.start()
    for way in ways:
        way.join()


def free_port():
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


class Server:
    """A pvserver with the plugin behind a link with a port of its own, for one client."""

    def __init__(self, display=None):
        # pvpython has begun an MPI job of its own, of which this is no part.
        environment = {name: value for name, value in os.environ.items()
                       if name.startswith("OMPI_ALLOW") or not name.startswith(("OMPI_", "PMIX_"))}
        if display:
            environment["DISPLAY"] = display
        plugin = pathlib.Path(os.environ["SONOVDB_PLUGIN"])
        port = free_port()
        self.said = []
        self.process = subprocess.Popen(
            ["pvserver", f"--server-port={port}", f"--plugin-search-paths={plugin.parent}", "--plugins=SonoVDB"],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment)
        for line in self.process.stdout:
            self.said.append(line)
            if "Accepting connection" in line:
                break
        self.listener = threading.Thread(target=lambda: self.said.extend(self.process.stdout))
        self.listener.start()
        self.counts = tempfile.NamedTemporaryFile()
        self.counts.write(COUNTS.pack(0, 0))
        self.counts.flush()
        self.link = subprocess.Popen([shutil.which("python3"), __file__, str(port), self.counts.name],
                                     stdout=subprocess.PIPE, text=True, env=environment)
        self.port = int(self.link.stdout.readline())

    def crossed(self):
        """Bytes from the server and to it so far."""
        return COUNTS.unpack(pathlib.Path(self.counts.name).read_bytes())

    def close(self):
        for process in (self.process, self.link):
            process.terminate()
            process.wait()
        self.listener.join()
        for file in (self.process.stdout, self.link.stdout, self.counts):
            file.close()


if __name__ == "__main__":
    serve(int(sys.argv[1]), sys.argv[2])
