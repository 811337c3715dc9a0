// The 3D view of a report: input and output of one mesh side by side, turned together.
//
// The page holds <script type="application/json" id="meshes">, a list of scenes {title, views}. A view
// {title, note, box_low, box_high, low, size, positions, indices} is a mesh: `positions` are base64 of
// little-endian Uint16 triples, 0 to 65535 across the cube at `low` with edge `size` (input units);
// `indices` of Uint32 triples, counterclockwise seen from outside.
//
// A frame is drawn when something changed, and never otherwise.
import {
  AmbientLight, BackSide, Box3, BufferAttribute, BufferGeometry, Color, DirectionalLight, FrontSide, Mesh,
  MeshLambertMaterial, PerspectiveCamera, Scene, Vector3, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

const CLAY = 0xcfc6ba;
const BACK = 0xc0473b; // the back of a face: a hole or a flipped face shows
const FIELD_OF_VIEW = 32; // degrees
const NARROW = 640; // pixels; below it the meshes stand one above the other

function bytes(base64) {
  const text = atob(base64);
  const result = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) result[i] = text.charCodeAt(i);
  return result.buffer;
}

function geometryOf(view) {
  const packed = new Uint16Array(bytes(view.positions));
  const positions = new Float32Array(packed.length);
  for (let i = 0; i < packed.length; ++i) positions[i] = view.low[i % 3] + (view.size * packed[i]) / 65535;
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(positions, 3));
  geometry.setIndex(new BufferAttribute(new Uint32Array(bytes(view.indices)), 1));
  return geometry;
}

// Front and back of every face have a colour each; the lights come with the camera.
function sceneOf(view) {
  const scene = new Scene();
  const geometry = geometryOf(view);
  for (const [side, color] of [[FrontSide, CLAY], [BackSide, BACK]]) {
    // Where front and back are too close to tell which is nearer, the front is meant to show.
    const polygonOffset = side === BackSide;
    scene.add(new Mesh(geometry, new MeshLambertMaterial({
      color, side, flatShading: true, polygonOffset, polygonOffsetFactor: 1, polygonOffsetUnits: 4,
    })));
  }
  return scene;
}

// How far from the centre of a box a camera in a direction (of length 1) has all of it in view.
function distanceFor(box, direction, up, aspect) {
  const right = new Vector3().crossVectors(up, direction).normalize();
  const above = new Vector3().crossVectors(direction, right);
  const tangent = Math.tan((FIELD_OF_VIEW * Math.PI) / 360);
  const half = box.getSize(new Vector3()).multiplyScalar(0.5);
  let distance = 0;
  for (let i = 0; i < 8; ++i) {
    const corner = new Vector3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1).multiply(half);
    const across = Math.max(Math.abs(corner.dot(right)) / aspect, Math.abs(corner.dot(above))) / tangent;
    distance = Math.max(distance, corner.dot(direction) + across);
  }
  return 1.04 * distance;
}

function start(root, scenes) {
  const canvas = root.querySelector('canvas');
  const captions = root.querySelector('.captions');
  const choice = root.querySelector('select');
  const renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
  renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
  renderer.setScissorTest(true);
  const camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.01, 100);
  const lights = [new AmbientLight(0xffffff, 0.75), new DirectionalLight(0xffffff, 2.3),
    new DirectionalLight(0xffffff, 0.5)];
  lights[1].position.set(-0.6, 0.9, 1);
  lights[2].position.set(1, -0.3, 0.6);
  for (const light of lights) camera.add(light);
  camera.up.set(0, 0, 1);
  const controls = new OrbitControls(camera, canvas);
  let shown = [];
  let waiting = false;

  function draw() {
    waiting = false;
    const width = canvas.clientWidth;
    const height = canvas.clientHeight;
    const stacked = width < NARROW;
    const count = Math.max(1, shown.length);
    const w = stacked ? width : width / count;
    const h = stacked ? height / count : height;
    camera.aspect = w / h;
    camera.updateProjectionMatrix();
    renderer.setClearColor(new Color(0), 0);
    shown.forEach((scene, i) => {
      const x = stacked ? 0 : i * w;
      const y = stacked ? (count - 1 - i) * h : 0;
      renderer.setViewport(x, y, w, h);
      renderer.setScissor(x, y, w, h);
      scene.add(camera); // with its lights
      renderer.render(scene, camera);
    });
    root.dataset.frames = String(Number(root.dataset.frames || 0) + 1);
  }
  function request() {
    if (!waiting) requestAnimationFrame(draw);
    waiting = true;
  }
  function resize() {
    const stacked = root.clientWidth < NARROW;
    canvas.style.height = `${stacked ? shown.length * Math.round(root.clientWidth * 0.75)
      : Math.min(460, Math.round(root.clientWidth * 0.42))}px`;
    renderer.setSize(canvas.clientWidth, canvas.clientHeight, false);
    request();
  }
  function show(number) {
    for (const scene of shown) {
      scene.remove(camera);
      scene.traverse((node) => {
        node.geometry?.dispose();
        node.material?.dispose();
      });
    }
    const { views } = scenes[number];
    shown = views.map(sceneOf);
    captions.replaceChildren(...views.map((view) => {
      const caption = document.createElement('div');
      const title = document.createElement('strong');
      title.textContent = view.title;
      caption.append(title, ` ${view.note}`);
      return caption;
    }));
    const box = new Box3();
    for (const view of views) {
      box.expandByPoint(new Vector3(...view.box_low)).expandByPoint(new Vector3(...view.box_high));
    }
    const centre = box.getCenter(new Vector3());
    resize();
    const stacked = canvas.clientWidth < NARROW;
    const aspect = (canvas.clientWidth / canvas.clientHeight) * (stacked ? views.length : 1 / views.length);
    const direction = new Vector3(1, -1.2, 0.7).normalize();
    const distance = distanceFor(box, direction, camera.up, aspect);
    camera.position.copy(direction).multiplyScalar(distance).add(centre);
    camera.near = distance / 1000;
    camera.far = distance * 10;
    controls.target.copy(centre);
    controls.update();
    request();
  }

  controls.addEventListener('change', request);
  choice.addEventListener('change', () => show(Number(choice.value)));
  new ResizeObserver(resize).observe(root);
  show(0);
}

const root = document.getElementById('viewer');
const scenes = JSON.parse(document.getElementById('meshes').textContent);
try {
  start(root, scenes);
} catch (error) {
  // A browser without WebGL: the rest of the page stands on its own.
  root.querySelector('.captions').textContent = `The 3D view could not start: ${error.message}`;
  root.querySelector('canvas').remove();
}
