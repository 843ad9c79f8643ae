// Shows the overhead image with everything drawn on it.
import OlMap from 'ol/Map';
import View from 'ol/View';
import Feature from 'ol/Feature';
import LineString from 'ol/geom/LineString';
import MultiLineString from 'ol/geom/MultiLineString';
import Polygon from 'ol/geom/Polygon';
import PointGeometry from 'ol/geom/Point';
import TileLayer from 'ol/layer/Tile';
import VectorLayer from 'ol/layer/Vector';
import VectorSource from 'ol/source/Vector';
import XYZ from 'ol/source/XYZ';
import TileGrid from 'ol/tilegrid/TileGrid';
import Projection from 'ol/proj/Projection';
import { ScaleLine, Zoom } from 'ol/control';
import { defaults as defaultInteractions } from 'ol/interaction';
import { boundingExtent, buffer, containsExtent, createEmpty, extend, type Extent } from 'ol/extent';
import { cornersOf, middleOf } from './geometry';
import { styleOf, sketchStyle, shown } from './styles';
import type { Selection, Store } from '../store';
import { isOnGround, isRejected, type Label, type Point, type Start } from '../types';

const kMoveMs = 180;

export class GroundMap {
  readonly map: OlMap;
  readonly layers: Record<string, VectorLayer>;
  readonly marked = new VectorSource();
  readonly markedLayer: VectorLayer;
  private readonly labels = new VectorSource();
  private readonly rejected = new VectorSource();
  private readonly hypotheses = new VectorSource();
  private readonly sketch = new VectorSource();
  /** The drawn labels. The map redraws only labels that changed. */
  private readonly drawn = new Map<number, Label>();
  /**
   * The label that keys are moving. Only the layer of the selected object draws it, so that the
   * other labels need no redraw.
   */
  private moving: Label | null = null;
  private readonly extent: Extent;

  constructor(
    target: HTMLElement,
    private readonly store: Store,
  ) {
    const { picture, poses } = store.start;
    const tracks = poses.map((track) => track.map(([x, y]): Point => [x, y]));
    this.extent = picture?.extent ?? extentOf(tracks);
    const { extent } = this;
    const resolutions = picture?.resolutions ?? [1, 0.02];
    const projection = new Projection({ code: 'MAP', units: 'm', extent });
    const vectors = (source: VectorSource, zIndex: number): VectorLayer =>
      new VectorLayer({ source, zIndex, style: (f, r) => styleOf(f as Feature, r, store) });
    this.layers = {
      lanes: vectors(lines(store.start.lanes, 'lane'), 1),
      poses: vectors(lines(tracks, 'pose'), 2),
      rejected: vectors(this.rejected, 3),
      hypotheses: vectors(this.hypotheses, 4),
      labels: vectors(this.labels, 5),
    };
    this.markedLayer = vectors(this.marked, 6);
    this.map = new OlMap({
      target,
      controls: [new ScaleLine(), new Zoom()],
      interactions: defaultInteractions({ keyboard: false, doubleClickZoom: false }),
      layers: [
        ...(picture ? [tileLayer(picture, projection)] : []),
        ...Object.values(this.layers),
        this.markedLayer,
        new VectorLayer({ source: this.sketch, style: sketchStyle, zIndex: 7 }),
      ],
      view: new View({
        projection,
        constrainOnlyCenter: true,
        extent,
        maxResolution: resolutions[0] * 4,
        minResolution: resolutions[resolutions.length - 1] / 8,
      }),
    });
    this.map.getView().fit(extent, { padding: [20, 20, 20, 20] });
    // Publishes the position of the map for tools that control the page.
    this.map.on('moveend', () => {
      const [x, y] = this.centre();
      target.dataset.place = `${x} ${y} ${this.map.getView().getResolution()}`;
    });
    store.on('labels', () => this.drawLabels());
    store.on('hypotheses', () => this.drawHypotheses());
    store.on('selection', () => {
      if (this.moving && this.moving.id !== store.selectedLabel()?.id) this.drawLabels();
      else this.drawMarked();
    });
    store.on('classes', () => {
      for (const layer of [...Object.values(this.layers), this.markedLayer]) layer.changed();
    });
  }

  private drawLabels(): void {
    this.moving = this.movedByKeys();
    for (const label of this.store.labels.values()) {
      if (!isOnGround(label) || this.drawn.get(label.id) === label) continue;
      this.removeFeature(label.id);
      if (label === this.moving) continue;
      this.drawn.set(label.id, label);
      if (label.deleted || label.corners.length === 0) continue;
      (isRejected(label) ? this.rejected : this.labels).addFeature(labelFeature(label));
    }
    for (const id of [...this.drawn.keys()]) if (!this.store.labels.has(id)) this.removeFeature(id);
    this.drawMarked();
  }

  // The selected label, if keys have changed its shape and the version is still the same.
  private movedByKeys(): Label | null {
    const label = this.store.selectedLabel();
    if (!label) return null;
    const before = this.moving?.id === label.id ? this.moving : this.drawn.get(label.id);
    const moves = before?.version === label.version && this.drawn.get(label.id) !== label;
    return moves ? label : null;
  }

  private removeFeature(id: number): void {
    this.drawn.delete(id);
    for (const source of [this.labels, this.rejected]) {
      const old = source.getFeatureById(id);
      if (old) source.removeFeature(old);
    }
  }

  private drawHypotheses(): void {
    const asked = new Set(this.store.openQuestions());
    this.hypotheses.clear(true);
    const features = [...this.store.hypotheses.values()]
      .filter((h) => shown(h, asked))
      .map((h) => {
        const feature = new Feature(polygon(cornersOf(h)));
        feature.setProperties(
          { type: 'hypothesis', index: h.index, kind: h.kind, probability: h.probability },
          true,
        );
        return feature;
      });
    this.hypotheses.addFeatures(features);
    this.drawMarked();
  }

  private drawMarked(): void {
    const corners = this.selectedCorners();
    this.marked.clear(true);
    if (!corners) return;
    const feature = new Feature(polygon(corners));
    const hypothesis = this.store.selectedHypothesis();
    const kind = hypothesis?.kind ?? this.store.selectedLabel()!.kind;
    feature.setProperties({ type: 'marked', kind, asked: hypothesis !== null }, true);
    this.marked.addFeature(feature);
  }

  selectedCorners(): Point[] | null {
    const hypothesis = this.store.selectedHypothesis();
    if (hypothesis) return cornersOf(hypothesis);
    const label = this.store.selectedLabel();
    return label && label.corners.length > 0 ? label.corners : null; // null for a label without a place in the map
  }

  /** Shows the lines and points of the shape that the user is drawing or moving. */
  showSketch(points: Point[], closed: boolean): void {
    this.sketch.clear(true);
    if (points.length > 1)
      this.sketch.addFeature(
        new Feature(closed ? polygon(points) : new LineString(points)),
      );
    for (const p of points) this.sketch.addFeature(new Feature(new PointGeometry(p)));
  }

  /** Moves the selected object to the centre and makes it large enough to judge. */
  showSelected(zoom = true): void {
    const corners = this.selectedCorners();
    if (!corners) return;
    const extent = extend(createEmpty(), polygon(corners).getExtent());
    const view = this.map.getView();
    const size = Math.max(extent[2] - extent[0], extent[3] - extent[1], 2);
    const [width, height] = this.map.getSize() ?? [800, 600];
    const resolution = (size * 5) / Math.min(width, height);
    const now = view.getResolution() ?? resolution;
    const keep = !zoom || (now > resolution / 2 && now < resolution * 1.5);
    view.cancelAnimations();
    view.animate({
      center: [(extent[0] + extent[2]) / 2, (extent[1] + extent[3]) / 2],
      resolution: keep ? now : resolution,
      duration: kMoveMs,
    });
  }

  /** Shows the whole place. */
  showAll(): void {
    this.map.getView().fit(this.extent, { padding: [20, 20, 20, 20], duration: kMoveMs });
  }

  /**
   * Moves to the position at which most of these boxes are completely visible, without a change of
   * scale. Returns false if there are no boxes.
   */
  showDensestArea(boxes: Point[][]): boolean {
    if (boxes.length === 0) return false;
    const view = this.map.getView();
    const [width, height] = this.map.getSize()!.map((px) => (px * view.getResolution()!) / 2);
    const middles = boxes.map(middleOf);
    // Counts the neighbours that fit around each box. The margin leaves room for the size of a box.
    const count = ([x, y]: Point): number =>
      middles.filter(([u, v]) => Math.abs(u - x) < width * 0.8 && Math.abs(v - y) < height * 0.8).length;
    const best = middles.reduce((a, b) => (count(b) > count(a) ? b : a));
    view.cancelAnimations();
    view.animate({ center: best, duration: kMoveMs });
    return true;
  }

  /** Moves to a place if it is not visible. */
  showPlace(corners: Point[]): void {
    if (!this.isInView(corners)) this.map.getView().animate({ center: middleOf(corners), duration: kMoveMs });
  }

  isInView(corners: Point[]): boolean {
    return containsExtent(this.map.getView().calculateExtent(), polygon(corners).getExtent());
  }

  pan(right: number, up: number): void {
    const view = this.map.getView();
    const [x, y] = view.getCenter()!;
    const step = view.getResolution()! * 60;
    view.setCenter([x + right * step, y + up * step]);
  }

  zoomBy(delta: number): void {
    const view = this.map.getView();
    view.setZoom(view.getZoom()! + delta);
  }

  centre(): Point {
    return this.map.getView().getCenter() as Point;
  }

  /**
   * Returns the label or hypothesis at a pixel. The selected object comes last, because other
   * objects may lie on it.
   */
  at(pixel: number[]): Selection | null {
    const others: Selection[] = [];
    let marked = false;
    this.map.forEachFeatureAtPixel(
      pixel,
      (feature) => {
        const type = feature.get('type') as string;
        if (type === 'label') others.push({ type, id: feature.getId() as number });
        else if (type === 'hypothesis') others.push({ type, index: feature.get('index') as number });
        else marked ||= type === 'marked';
        return others.length > 0;
      },
      { hitTolerance: 4 },
    );
    return others[0] ?? (marked ? this.store.selection : null);
  }
}

function tileLayer(picture: NonNullable<Start['picture']>, projection: Projection): TileLayer {
  const { version, extent, resolutions, tile_px } = picture;
  const tileGrid = new TileGrid({ extent, origin: [extent[0], extent[3]], resolutions, tileSize: tile_px });
  const url = `tiles/{z}/{x}/{y}.png?v=${version}`;
  return new TileLayer({ source: new XYZ({ projection, url, tileGrid, transition: 0 }) });
}

function extentOf(lines: Point[][]): Extent {
  return buffer(boundingExtent(lines.flat()), 10);
}

function polygon(corners: Point[]): Polygon {
  return new Polygon([[...corners, corners[0]]]);
}

function labelFeature(label: Label): Feature {
  const feature = new Feature(polygon(label.corners));
  feature.setId(label.id);
  feature.setProperties({ type: 'label', kind: label.kind, box: label.shape === 'box' }, true);
  return feature;
}

function lines(list: Point[][], type: string): VectorSource {
  const feature = new Feature(new MultiLineString(list.filter((line) => line.length > 1)));
  feature.setProperties({ type }, true);
  return new VectorSource({ features: [feature] });
}
