"""slow_clients.py ROADBOOK MAKE_LOT COUNT LIMIT_S: COUNT clients of the labelling server send a request byte by byte, or a body, or
nothing, and come again when they are turned away. Each request of an honest client meanwhile takes less than LIMIT_S."""
import http.client
import os
import socket
import subprocess
import sys
import tempfile
import threading
import time

program, make_lot, count, limit_s = sys.argv[1], sys.argv[2], int(sys.argv[3]), float(sys.argv[4])
MEASURED_S = 8.0
stop = threading.Event()


def dawdle(port, token, kind):
    """One slow client: 0 a head, 1 a body, 2 nothing."""
    head = (f"POST /api/labels HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nAuthorization: Bearer {token}\r\nOrigin: http://127.0.0.1:{port}\r\n"
            "Content-Type: application/json\r\nContent-Length: 100000\r\n\r\n").encode()
    while not stop.is_set():
        try:
            with socket.create_connection(("127.0.0.1", port), timeout=30) as connection:
                if kind == 1:
                    connection.sendall(head)
                connection.settimeout(0.2)
                for i in range(100000):
                    if stop.is_set():
                        return
                    if kind < 2:
                        connection.sendall(head[i % len(head):][:1] if kind == 0 else b" ")
                    try:
                        if not connection.recv(4096):
                            break
                    except socket.timeout:
                        pass
        except OSError:
            time.sleep(0.01)


def ask(port, token):
    begin = time.monotonic()
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=60)
    connection.request("GET", "/api/labels", headers={"Authorization": "Bearer " + token})
    answer = connection.getresponse()
    answer.read()
    connection.close()
    if answer.status != 200:
        sys.exit(f"status {answer.status}, want 200")
    return time.monotonic() - begin


with tempfile.TemporaryDirectory() as folder:
    place = os.path.join(folder, "lot.gpkg")
    subprocess.run([make_lot, place], check=True, stdout=subprocess.DEVNULL)
    server = subprocess.Popen([program, "label", "-m", place, "--port", "0", "--token-file", os.path.join(folder, "token")],
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    try:
        address, token = server.stdout.readline().split("http://")[1].strip().split("/?token=")
        port = int(address.split(":")[1])
        alone_s = ask(port, token)
        slow = [threading.Thread(target=dawdle, args=(port, token, i % 3), daemon=True) for i in range(count)]
        for thread in slow:
            thread.start()
        begin = time.monotonic()
        delays = []
        while time.monotonic() < begin + MEASURED_S:
            delays.append(ask(port, token))
        stop.set()
    finally:
        server.kill()
print(f"{count} slow clients: {len(delays)} requests, longest {max(delays):.2f} s (alone {alone_s:.3f} s)")
sys.exit(0 if max(delays) < limit_s else 1)
