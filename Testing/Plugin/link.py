"""A link between a client and a pvserver that counts the bytes which cross it, each way."""
import os
import pathlib
import socket
import subprocess
import threading

PIECE = 1 << 20


def free_port():
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


class Link:
    """Clients connect to `port` instead of to the server's."""

    def __init__(self, server_port):
        self.server_port = server_port
        self.down = 0  # bytes, from the server to the client
        self.up = 0
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        threading.Thread(target=self._accept, daemon=True).start()

    def close(self):
        self.listener.close()

    def _accept(self):
        while True:
            try:
                client, _ = self.listener.accept()
            except OSError:
                return  # closed
            server = socket.create_connection(("127.0.0.1", self.server_port))
            for end in (client, server):
                end.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            threading.Thread(target=self._pass_on, args=(server, client, "down"), daemon=True).start()
            threading.Thread(target=self._pass_on, args=(client, server, "up"), daemon=True).start()

    def _pass_on(self, source, sink, way):
        try:
            while piece := source.recv(PIECE):
                setattr(self, way, getattr(self, way) + len(piece))
                sink.sendall(piece)
            sink.shutdown(socket.SHUT_WR)
        except OSError:
            pass  # an end has left


class Server:
    """A pvserver with the plugin, and the link to it; ends with the context."""

    def __init__(self, *arguments, display=None):
        # pvpython has begun an MPI job of its own, of which this is no part.
        environment = {name: value for name, value in os.environ.items()
                       if name.startswith("OMPI_ALLOW") or not name.startswith(("OMPI_", "PMIX_"))}
        if display:
            environment["DISPLAY"] = display
        plugin = pathlib.Path(os.environ["SONOVDB_PLUGIN"])
        port = free_port()
        self.process = subprocess.Popen(
            ["pvserver", f"--server-port={port}", f"--plugin-search-paths={plugin.parent}", "--plugins=SonoVDB", *arguments],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment)
        self.said = []
        for line in self.process.stdout:
            self.said.append(line)
            if "Accepting connection" in line:
                break
        threading.Thread(target=lambda: self.said.extend(self.process.stdout), daemon=True).start()
        self.link = Link(port)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.link.close()
        self.process.terminate()
        self.process.wait()
