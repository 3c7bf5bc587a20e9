// The film's keys: on the time line, and in the browser's own storage until they are saved.

class FilmMarks {
  // `send(command)`. The line's first frame is 1.
  constructor(marks, send) {
    this.marks = marks;
    this.send = send;
    this.last = 1;
    this.dragged = null;
  }

  // While a mark is dragged the others stay as they are.
  show(frames, last) {
    this.last = Math.max(2, last);
    if (this.dragged) return;
    const focused = document.activeElement?.dataset.frame;
    this.marks.replaceChildren(...frames.filter((frame) => frame <= this.last).map((frame) => this.mark(frame)));
    if (this.marks.contains(document.activeElement) || !focused) return;
    this.marks.querySelector(`[data-frame="${this.moved ?? focused}"]`)?.focus();
    this.moved = null;
  }

  place(mark, frame) {
    mark.style.left = `${100 * (frame - 1) / (this.last - 1)}%`;
  }

  mark(frame) {
    const mark = document.createElement("button");
    mark.dataset.frame = frame;
    mark.title = `Key at frame ${frame}: drag it to another`;
    mark.setAttribute("aria-label", `Key at frame ${frame}: arrow keys move it`);
    this.place(mark, frame);
    mark.onpointerdown = (event) => {
      mark.setPointerCapture(event.pointerId);
      this.dragged = {mark, to: frame};
    };
    mark.onpointermove = (event) => {
      if (this.dragged?.mark !== mark) return;
      const line = this.marks.getBoundingClientRect();
      const share = Math.max(0, Math.min(1, (event.clientX - line.left) / line.width));
      this.dragged.to = 1 + Math.round(share * (this.last - 1));
      this.place(mark, this.dragged.to);
    };
    mark.onpointerup = () => {
      const {to} = this.dragged ?? {to: frame};
      this.dragged = null;
      if (to !== frame) this.send({do: "move", frame, to});
      else showKey(frame);
    };
    mark.onpointercancel = () => {
      this.dragged = null;
      this.place(mark, frame);
    };
    mark.onkeydown = (event) => {
      const by = {ArrowLeft: -1, ArrowRight: 1}[event.key];
      if (!by || frame + by < 1) return;
      event.preventDefault();
      event.stopPropagation();
      this.moved = frame + by;
      this.send({do: "move", frame, to: frame + by});
    };
    return mark;
  }
}

// What the pilot has recorded and not saved outlives the program, under the scene's title.
class UnsavedFilm {
  constructor(title) {
    this.name = `pprt-film:${title}`;
  }

  get() {
    try {
      return JSON.parse(localStorage.getItem(this.name));
    } catch {
      return null;
    }
  }

  // A browser may refuse to store anything.
  put(film) {
    try {
      localStorage.setItem(this.name, JSON.stringify(film));
    } catch (error) {
      console.warn(error);
    }
  }

  forget() {
    try {
      localStorage.removeItem(this.name);
    } catch (error) {
      console.warn(error);
    }
  }
}
