// The page's WebSocket: frames come in, commands go out. It connects again when it is lost.

function headerAndBytes(buffer) {
  const bytes = new Uint8Array(buffer);
  const end = bytes.indexOf(10);
  return [JSON.parse(new TextDecoder().decode(bytes.subarray(0, end))), bytes.subarray(end + 1)];
}

class Connection {
  // `on`: frame(header, bytes), photo(header, bytes), text(message), lost(secondsToNextTry), found()
  constructor(on) {
    this.on = on;
    this.tries = 0;
    this.ended = false;
    this.open();
  }

  open() {
    const address = location.href.replace(/^http/, "ws").replace(/[^/]*$/, "") + "socket";
    this.socket = new WebSocket(address);
    this.socket.binaryType = "arraybuffer";
    this.socket.onopen = () => {
      this.tries = 0;
      this.on.found();
    };
    this.socket.onmessage = (event) => this.receive(event.data);
    this.socket.onclose = () => {
      if (this.ended) return;
      const seconds = Math.min(8, 0.5 * 2 ** this.tries++);
      this.on.lost(seconds);
      setTimeout(() => this.open(), 1000 * seconds);
    };
  }

  receive(data) {
    if (typeof data === "string") {
      const message = JSON.parse(data);
      if (message.end) this.ended = true;
      this.on.text(message);
      return;
    }
    const [header, bytes] = headerAndBytes(data);
    if (header.photo) {
      this.on.photo(header, bytes);
    } else {
      this.on.frame(header, bytes);
    }
  }

  // A frame has been seen: the next may come.
  acknowledge() {
    this.sendText("ack");
  }

  send(command) {
    this.sendText(JSON.stringify(command));
  }

  sendText(text) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(text);
  }
}
