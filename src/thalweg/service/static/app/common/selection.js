// One selection for chart, cards, profile, front and table: the route and the time.

class Selection extends EventTarget {
  route = 0;
  hovered = null;
  time = null;

  choose(route) {
    if (route === this.route) return;
    this.route = route;
    this.dispatchEvent(new Event("route"));
  }

  hover(route) {
    if (route === this.hovered) return;
    this.hovered = route;
    this.dispatchEvent(new Event("hover"));
  }

  at(time) {
    if (time === this.time) return;
    this.time = time;
    this.dispatchEvent(new Event("time"));
  }
}

export const selection = new Selection();
